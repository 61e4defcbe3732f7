// SPDX-License-Identifier: MIT
// What the agent gets each step. Nothing else reaches the policy, apart from the goal's name.
#pragma once

#include <cstdint>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"

namespace crossnav {

struct Observation {
  RgbImage rgb;             ///< H x W
  DepthImage depth_m;       ///< H x W, planar z [m]; 0, NaN, inf = invalid
  CameraIntrinsics camera;  ///< of both images
  Pose T_world_camera = Pose::Identity();
  std::int64_t time_ns = 0;  ///< of the depth image, since its sensor's epoch; 0 = not known
};

}  // namespace crossnav
