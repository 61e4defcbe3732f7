// SPDX-License-Identifier: MIT
// Two cameras into one grid: lens distortion is taken out, and depth is seen from the colour
// camera.
#pragma once

#include <array>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"

namespace crossnav::recordings {

/// A pinhole with the lens of Brown and Conrady: k1 k2 p1 p2 k3 k4 k5 k6 (the last three divide, as
/// ROS' rational_polynomial has it).
struct CameraModel {
  CameraIntrinsics K;
  std::array<double, 8> distortion{};

  bool IsDistorted() const { return distortion != std::array<double, 8>{}; }
};

/// The image that the same pinhole without a lens would give; nearest pixel, 0 beyond the edge.
RgbImage Rectify(const RgbImage& image, const CameraModel& camera);
DepthImage Rectify(const DepthImage& depth_m, const CameraModel& camera);

/// Planar depth [m] seen by `colour`, of its size; 0 where no surface is. Each depth pixel covers
/// what its square covers there, the nearest wins; the same camera gives the same image.
DepthImage RegisterDepth(const DepthImage& depth_m, const CameraIntrinsics& depth,
                         const CameraIntrinsics& colour, const Pose& T_colour_depth);

}  // namespace crossnav::recordings
