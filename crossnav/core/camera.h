// SPDX-License-Identifier: MIT
// Pinhole camera. Pixel (u, v) has its centre at the integer coordinate, so the principal point of
// an image of width W is (W - 1) / 2.
#pragma once

#include "crossnav/core/pose.h"
#include "crossnav/core/setting.h"

namespace crossnav {

struct CameraIntrinsics {
  int width_px = 0;
  int height_px = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;  // [px]
  friend bool operator==(const CameraIntrinsics&, const CameraIntrinsics&) = default;
};

/// Square pixels, horizontal field of view `hfov_rad` in (0, pi).
CameraIntrinsics IntrinsicsFromHfov(int width_px, int height_px, double hfov_rad);

/// Point at planar depth `depth_m` behind pixel (u, v), in the camera frame.
inline Vector3d BackProjectPixel(const CameraIntrinsics& K, double u, double v, double depth_m) {
  return {(u - K.cx) * depth_m / K.fx, (v - K.cy) * depth_m / K.fy, depth_m};
}

/// The sensor of the paper's configuration table (tab:supp_configuration).
struct SensorConfig {
  int width_px = 640;
  int height_px = 640;
  double hfov_deg = 90;
  double camera_height_m = 0.88;  ///< above the ground under the agent

  CameraIntrinsics Intrinsics() const {
    return IntrinsicsFromHfov(width_px, height_px, DegToRad(hfov_deg));
  }
};

template <class V>
void Visit(V& visit, SensorConfig& c) {
  visit(CROSSNAV_SETTING(c, width_px), 8, 8192);
  visit(CROSSNAV_SETTING(c, height_px), 8, 8192);
  visit(CROSSNAV_SETTING(c, hfov_deg), 1.0, 179.0);
  visit(CROSSNAV_SETTING(c, camera_height_m), 0.01, 5.0);
}

}  // namespace crossnav
