// SPDX-License-Identifier: MIT
// The surface that voxels tell of, finer than a voxel: the plane through the surface voxels around
// one. A noisy sensor makes walls of several voxels' thickness; the plane lies in their middle.
// World frame, metres.
#pragma once

#include <optional>

#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry {

struct SurfacePlane {
  Vector3d p_world = Vector3d::Zero();       ///< on the plane
  Vector3d normal_world = Vector3d::Zero();  ///< unit length, of either sign
};

/// Least-squares plane through the centres of the surface voxels at most two voxels from `key` on
/// each axis. Nothing where there are fewer than five, or they do not make a surface.
std::optional<SurfacePlane> PlaneAround(const VoxelMap& map, const VoxelKey& key);

}  // namespace crossnav::geometry
