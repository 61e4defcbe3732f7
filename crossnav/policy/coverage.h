// SPDX-License-Identifier: MIT
// Which places were looked at from near enough for the detector to answer: a voxel seen from 10 m
// is not a place inspected for the goal. Kept in coarse cells, per goal. World frame.
#pragma once

#include <unordered_set>

#include "crossnav/core/pose.h"
#include "crossnav/geometry/end_voxel_list.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::policy {

class Coverage {
 public:
  /// Marks the frame's end voxels within `range_m` of the camera as inspected.
  void Add(const geometry::EndVoxels& ends, const Vector3d& p_camera_world, double range_m,
           double voxel_m);

  /// Whether something at the place to stand `key`, or up to half a metre over it, was inspected.
  bool IsInspected(const geometry::VoxelKey& key) const;

  void Clear() { cells_.clear(); }

 private:
  std::unordered_set<geometry::VoxelKey, geometry::VoxelKeyHash> cells_;
};

}  // namespace crossnav::policy
