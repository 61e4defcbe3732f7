// SPDX-License-Identifier: MIT
#include "crossnav/policy/coverage.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;

/// 0.4 x 0.4 x 0.8 m at the usual voxel size: the footprint of a chair.
VoxelKey CoverageCellOf(const VoxelKey& key) {
  return {key.x >> 2, key.y >> 2, key.z >> 3};
}

}  // namespace

void Coverage::Add(const geometry::EndVoxels& ends, const Vector3d& p_camera_world, double range_m,
                   double voxel_m) {
  VoxelKey last{1 << 30, 0, 0};
  for (const geometry::EndRun& run : ends.runs()) {
    const VoxelKey cell = CoverageCellOf(run.key);
    if (cell == last) continue;
    const Vector3d d = geometry::CenterOf(run.key, voxel_m) - p_camera_world;
    if (d.x() * d.x() + d.y() * d.y() > range_m * range_m) continue;
    last = cell;
    cells_.insert(cell);
  }
}

bool Coverage::IsInspected(const VoxelKey& key) const {
  const VoxelKey support = CoverageCellOf({key.x, key.y, key.z - 1}),
                 above = CoverageCellOf({key.x, key.y, key.z + 4});
  return cells_.contains(support) || (above != support && cells_.contains(above));
}

}  // namespace crossnav::policy
