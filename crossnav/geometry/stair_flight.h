// SPDX-License-Identifier: MIT
// What is known of stairs beyond a goal, and saved with the memory: a flight as an object, which
// links two floors, and the voxels that were seen as stairs. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::geometry {

struct StairFlight {
  Vector3d p_foot_world = Vector3d::Zero();  ///< flat ground at its lower end
  Vector3d p_top_world = Vector3d::Zero();   ///< flat ground at its upper end
  std::vector<Vector3d> steps_world;         ///< where a foot was put, from foot to top
  double confidence = 0;  ///< share of the steps at which stair evidence was seen [0, 1]
  int walked_up = 0;
  int walked_down = 0;
};

/// A surface voxel that stair pixels fell on: what policy::StairVoxel keeps of it.
struct SeenStair {
  VoxelKey key;
  float probability = 0;     ///< best of the mask there [0, 1]
  float geometry_score = 0;  ///< best of a component it was part of [0, 1]
  bool is_confirmed = false;
};

}  // namespace crossnav::geometry
