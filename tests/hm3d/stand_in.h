// SPDX-License-Identifier: MIT
// Archives of HM3D's names and layout with a generated house in them, for docs/hm3d.md.
#pragma once

#include <filesystem>
#include <string>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::test {

/// Semantic mesh as HM3D's: instances are texels of a palette, and no vertex has a colour.
std::string PaletteSemanticGlb(const sim::Scene& scene);

/// Writes `<hash>.basis.glb`, `.basis.navmesh`, `.glb`, `.semantic.glb` and `.semantic.txt` of
/// `scene` into `folder`. Without an encoder of Basis Universal the first has PNG textures as well.
void WriteAsHm3d(const sim::Scene& scene, const std::string& hash,
                 const std::filesystem::path& folder);

/// Rewrites episodes of one goal as HM3D's ObjectNav v2 has them: an index without episodes, and
/// `content/<hash>.json.gz` beside it, in `folder`.
void WriteAsObjectNavV2(const std::filesystem::path& episodes, const std::string& hash,
                        const std::filesystem::path& folder);

}  // namespace crossnav::test
