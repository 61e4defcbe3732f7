// SPDX-License-Identifier: MIT
// Connected components of voxel sets. Deterministic: components in order of their smallest key,
// members sorted.
#pragma once

#include <vector>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::policy {

/// Components of `keys` under Chebyshev distance <= `reach_vox` (1 = 26-connected).
std::vector<std::vector<geometry::VoxelKey>> ConnectedClusters(std::vector<geometry::VoxelKey> keys,
                                                               int reach_vox = 1);

/// Mean of the voxels' centres [m].
Vector3d CentroidOf(const std::vector<geometry::VoxelKey>& keys, double voxel_m);

}  // namespace crossnav::policy
