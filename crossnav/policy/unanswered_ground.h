// SPDX-License-Identifier: MIT
// Ground that a depth camera looks at from near and gets no answer from: beyond the edge of a
// scanned world, behind a pane, a black floor. Looking again shows no more, so that it is no
// frontier. World frame.
#pragma once

#include <unordered_map>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::policy {

class UnansweredGround {
 public:
  /// Counts the frame. Returns the places, at the height of the foot, that it settles: columns at
  /// which enough frames looked without an answer, past air that is known.
  std::vector<geometry::VoxelKey> Look(const Observation& obs, const Vector3d& p_foot_world,
                                       const geometry::VoxelMap& map);

 private:
  std::unordered_map<geometry::VoxelKey, int, geometry::VoxelKeyHash> frames_;
};

}  // namespace crossnav::policy
