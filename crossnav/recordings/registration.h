// SPDX-License-Identifier: MIT
// Two cameras into one grid: removes lens distortion, and projects depth into the colour camera.
#pragma once

#include <array>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"

namespace crossnav::recordings {

/// A pinhole with a Brown-Conrady lens: k1 k2 p1 p2 k3 k4 k5 k6 (the last three divide, as in ROS'
/// rational_polynomial).
struct CameraModel {
  CameraIntrinsics K;
  std::array<double, 8> distortion{};

  bool IsDistorted() const { return distortion != std::array<double, 8>{}; }
};

/// Image of the same pinhole without lens; nearest pixel, 0 beyond the edge.
RgbImage Rectify(const RgbImage& image, const CameraModel& camera);
DepthImage Rectify(const DepthImage& depth_m, const CameraModel& camera);

/// Planar depth [m] as seen by `colour`, of its size; 0 without a surface. Each depth pixel covers
/// the projection of its square, the nearest wins; the same camera gives the same image.
DepthImage RegisterDepth(const DepthImage& depth_m, const CameraIntrinsics& depth,
                         const CameraIntrinsics& colour, const Pose& T_colour_depth);

}  // namespace crossnav::recordings
