// SPDX-License-Identifier: MIT
// A flight of stairs as an object: what links two floors. It outlives goals and sessions and is
// saved with the memory. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::geometry {

struct StairFlight {
  Vector3d p_foot_world = Vector3d::Zero();  ///< flat ground at its lower end
  Vector3d p_top_world = Vector3d::Zero();   ///< flat ground at its upper end
  std::vector<Vector3d> steps_world;         ///< where a foot was put, from foot to top
  double confidence = 0;  ///< share of the steps at which stair evidence was seen [0, 1]
  int walked_up = 0;
  int walked_down = 0;
};

}  // namespace crossnav::geometry
