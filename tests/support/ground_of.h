// SPDX-License-Identifier: MIT
// The ground of a map whose states were set by hand.
#pragma once

#include "crossnav/planner/ground_map.h"

namespace crossnav::test {

inline planner::GroundMap GroundOf(const geometry::VoxelMap& map) {
  planner::GroundMap ground(map.config());
  ground.Rebuild(map);
  return ground;
}

}  // namespace crossnav::test
