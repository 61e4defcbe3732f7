// SPDX-License-Identifier: MIT
// Level patches of one depth picture: floors, treads, seats. World frame, z up, metres.
#pragma once

#include <vector>

#include "crossnav/geometry/depth_surface.h"

namespace crossnav::geometry {

/// Connected, or of one height and near each other.
struct LevelPatch {
  std::vector<int> pixels;
  double height_m = 0;                         ///< median of its points
  double area_m2 = 0;                          ///< as seen
  Vector3d p_center_world = Vector3d::Zero();  ///< mean of its points
};

/// By height. `surface` is level.
std::vector<LevelPatch> LevelPatchesOf(const DepthSurface& surface);

}  // namespace crossnav::geometry
