// SPDX-License-Identifier: MIT
// Points and normals of one depth picture, levelled: turned about the camera so that the floor that
// is seen is level, since poses of real sensors lean by some degrees. World frame, z up, metres.
#pragma once

#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"

namespace crossnav::geometry {

/// All vectors are H x W, row by row. Pixels that are not measured, are not in the mask, or lie
/// beside another thing have the normal zero.
struct DepthSurface {
  int width = 0, height = 0;
  int reach_px = 1;  ///< distance of the neighbours that a normal is made of
  std::vector<Vector3d> p_world;
  std::vector<Vector3d> normal_world;  ///< unit length, towards the camera
  std::vector<double> area_m2;         ///< that the pixel covers on its surface
  std::vector<bool> is_measured;       ///< depth within limits, and in the mask

  int At(int u, int v) const { return v * width + u; }
};

/// `mask` empty = all pixels.
DepthSurface SurfaceOf(const DepthImage& depth_m, const CameraIntrinsics& camera,
                       const Pose& T_world_camera, const MaskImage& mask);

/// Normal of the level surfaces, by majority; the z axis if few surfaces are level.
Vector3d UpOf(const DepthSurface& surface);

/// Rotation about the camera that turns UpOf into the z axis.
Eigen::Matrix3d LevelBy(const Pose& T_world_camera, DepthSurface* surface);

}  // namespace crossnav::geometry
