// SPDX-License-Identifier: MIT
// Whether a sighting shows an object of its goal, by the boxes of a scene's instances.
#pragma once

#include <algorithm>
#include <string_view>

#include "crossnav/policy/live_poi.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav {

inline constexpr double kTruthMargin_m = 0.2;  // of an object's box: voxels, and the mask
inline constexpr double kTruthShare = 0.5;     // of a sighting's voxels that makes it the object's

inline bool IsThere(const policy::Sighting& sighting, std::string_view goal,
                    const sim::Scene& scene, double voxel_m) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const auto& instance) {
    if (instance.category != goal) return false;
    const auto inside =
        std::count_if(sighting.voxels.begin(), sighting.voxels.end(), [&](const auto& key) {
          const Vector3d p = geometry::CenterOf(key, voxel_m);
          return (p.array() >= instance.box.min.array() - kTruthMargin_m).all() &&
                 (p.array() <= instance.box.max.array() + kTruthMargin_m).all();
        });
    return static_cast<double>(inside) >= kTruthShare * static_cast<double>(sighting.voxels.size());
  });
}

}  // namespace crossnav
