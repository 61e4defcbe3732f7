// SPDX-License-Identifier: MIT
#include "crossnav/core/colour_grid.h"

#include <cmath>

#include "crossnav/core/check.h"

namespace crossnav {

Observation WithColourOnDepthGrid(const Observation& obs) {
  CROSSNAV_CHECK(HasOwnColourGrid(obs), "colour is on the grid of depth already");
  const CameraIntrinsics &K = obs.camera, &K_rgb = obs.rgb_camera;
  const Pose T_rgb_camera = obs.T_camera_rgb.inverse();
  const Eigen::Matrix3d R = T_rgb_camera.linear();
  const Vector3d t = T_rgb_camera.translation();
  const DepthImage& depth_m = obs.depth_m;

  Observation out;
  out.camera = K;
  out.T_world_camera = obs.T_world_camera;
  out.time_ns = obs.time_ns;
  out.T_base_camera = obs.T_base_camera;
  out.depth_m = depth_m;
  out.rgb = RgbImage(depth_m.width, depth_m.height);
  for (int v = 0; v < depth_m.height; ++v) {
    const Vector3d row = R.col(1) * ((v - K.cy) / K.fy) + R.col(2);
    for (int u = 0; u < depth_m.width; ++u) {
      const float measured_m = depth_m.At(u, v);
      const bool is_measured = std::isfinite(measured_m) && measured_m > 0;
      const double d = is_measured ? measured_m : kColourFarPlane_m;
      const Vector3d p_rgb = (R.col(0) * ((u - K.cx) / K.fx) + row) * d + t;
      if (p_rgb.z() <= 0) continue;
      const double u_rgb = std::floor(K_rgb.fx * p_rgb.x() / p_rgb.z() + K_rgb.cx + 0.5);
      const double v_rgb = std::floor(K_rgb.fy * p_rgb.y() / p_rgb.z() + K_rgb.cy + 0.5);
      const bool is_inside =
          u_rgb >= 0 && v_rgb >= 0 && u_rgb < K_rgb.width_px && v_rgb < K_rgb.height_px;
      if (is_inside)
        out.rgb.At(u, v) = obs.rgb.At(static_cast<int>(u_rgb), static_cast<int>(v_rgb));
    }
  }
  return out;
}

}  // namespace crossnav
