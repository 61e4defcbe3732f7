// SPDX-License-Identifier: MIT
// One instance of a scene as a separate scene, for rays that nothing else may block.
#pragma once

#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

// Heights of an object over the foot of the one who sees it.
// chosen: objects that begin higher hang over everything
inline constexpr double kAboveFoot_m = 2.2;
// chosen: objects that end lower are on another floor
inline constexpr double kBelowFoot_m = 0.3;

/// The triangles of instance `id` with the materials and textures they use (holes stay holes).
Scene ExtractInstance(const Scene& scene, int id);

}  // namespace crossnav::sim
