// SPDX-License-Identifier: MIT
// A depth pixel's point in the world, in voxels (paper, "RGB-D Projection and Sparse
// Voxelization"). Double precision throughout: the order of operations decides on which side of a
// voxel face a return lies, and is the same everywhere.
#pragma once

#include <cmath>

#include "crossnav/core/camera.h"
#include "crossnav/core/pose.h"

namespace crossnav::geometry {

/// Point at planar depth `depth_m` behind pixel (u, v), divided by the voxel edge.
inline Vector3d BackProjectToVoxels(const CameraIntrinsics& K, const Pose& T_world_camera, double u,
                                    double v, double depth_m, double voxel_m) {
  const double x = (u - K.cx) * depth_m / K.fx, y = (v - K.cy) * depth_m / K.fy, z = depth_m;
  const auto& T = T_world_camera.matrix();
  return {(T(0, 0) * x + T(0, 1) * y + T(0, 2) * z + T(0, 3)) / voxel_m,
          (T(1, 0) * x + T(1, 1) * y + T(1, 2) * z + T(1, 3)) / voxel_m,
          (T(2, 0) * x + T(2, 1) * y + T(2, 2) * z + T(2, 3)) / voxel_m};
}

/// How far a pixel's ray reaches, and whether something was hit there.
struct DepthReach {
  double depth_m = 0;  ///< 0: invalid pixel
  bool is_hit = false;
};

/// Depths of 0, NaN, inf or below the near limit are invalid. Beyond the far limit the ray is free
/// up to `depth_max_m`, without an end voxel.
inline DepthReach ReachOf(float depth_m, double depth_min_m, double depth_max_m) {
  if (!std::isfinite(depth_m) || depth_m < depth_min_m || !(depth_m > 0)) return {};
  if (depth_m > depth_max_m) return {depth_max_m, false};
  return {depth_m, true};
}

}  // namespace crossnav::geometry
