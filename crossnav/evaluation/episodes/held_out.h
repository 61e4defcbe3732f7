// SPDX-License-Identifier: MIT
// Compares a map with held-out frames: predicted depth, and free space. For recordings of real
// sensors without known true surfaces.
#pragma once

#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::evaluation {

struct HeldOutResult {
  std::vector<double> errors_m;  ///< |predicted - measured| along the optical axis, unsorted
  std::int64_t rays = 0;         ///< with a measured depth
  std::int64_t known = 0;        ///< of `rays`: the map knows their end
  std::int64_t violations = 0;   ///< of `known`: they end where the map and all around is free
};

/// Every fourth pixel of a row and column. A ray predicts its intersection with the plane through
/// the surface around its first surface voxel (geometry/surface_plane.h), or, without a plane, the
/// middle of its path through that voxel. A ray that meets unknown space first predicts no depth.
void AddHeldOut(const geometry::VoxelMap& map, const Observation& obs, HeldOutResult* result);

}  // namespace crossnav::evaluation
