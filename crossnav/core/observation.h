// SPDX-License-Identifier: MIT
// Observation: the agent's input of a step. Only the goal's name reaches the policy besides.
// Frames: world z up; camera x right, y down, z forward; base x ahead, z up, at the foot.
#pragma once

#include <cstdint>
#include <optional>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"

namespace crossnav {

struct Observation {
  RgbImage rgb;             ///< H x W; the size of `rgb_camera` where that has a width
  DepthImage depth_m;       ///< H x W, planar z [m]; 0, NaN, inf = invalid
  CameraIntrinsics camera;  ///< of depth, and of colour where `rgb_camera` has no width
  Pose T_world_camera = Pose::Identity();
  std::int64_t time_ns = 0;  ///< of the depth image, since its sensor's epoch; 0 = not known

  CameraIntrinsics rgb_camera;           ///< of a separate colour camera; width 0 = on depth's grid
  Pose T_camera_rgb = Pose::Identity();  ///< the colour camera in the depth camera's frame
  /// Mounting of the camera; empty = straight above the foot at the configured height.
  std::optional<Pose> T_base_camera;
};

/// Pose of the robot's foot: the base of the mounting, else `camera_height_m` below the camera. The
/// yaw is the base's, the pitch the camera's.
AgentPose FootPoseOf(const Observation& obs, double camera_height_m);

/// Height of the camera above the foot [m]: the mounting's, else `camera_height_m`.
double CameraHeightOf(const Observation& obs, double camera_height_m);

}  // namespace crossnav
