// SPDX-License-Identifier: MIT
// One instance of a scene as a separate scene, for rays that nothing else may block.
#pragma once

#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// The triangles of instance `id` with the materials and textures they use (holes stay holes).
Scene ExtractInstance(const Scene& scene, int id);

}  // namespace crossnav::sim
