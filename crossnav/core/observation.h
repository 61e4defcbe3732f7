// SPDX-License-Identifier: MIT
// What the agent gets each step. Nothing else reaches the policy, apart from the goal's name.
// Frames: world z up; camera x right, y down, z forward; base x ahead, z up, at the foot.
#pragma once

#include <cstdint>
#include <optional>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"

namespace crossnav {

struct Observation {
  RgbImage rgb;             ///< H x W, or as large as `rgb_camera` says
  DepthImage depth_m;       ///< H x W, planar z [m]; 0, NaN, inf = invalid
  CameraIntrinsics camera;  ///< of depth, and of colour where `rgb_camera` has no width
  Pose T_world_camera = Pose::Identity();
  std::int64_t time_ns = 0;  ///< of the depth image, since its sensor's epoch; 0 = not known

  CameraIntrinsics rgb_camera;           ///< of colour with a grid of its own; width 0 = on depth's
  Pose T_camera_rgb = Pose::Identity();  ///< the colour camera in the depth camera's frame
  /// How the camera is mounted; nothing = straight above the foot, as high as the settings say.
  std::optional<Pose> T_base_camera;
};

/// Where the robot stands: on the base of the mounting, else `camera_height_m` below the camera.
/// The yaw is that of the base, the pitch that of the camera.
AgentPose FootPoseOf(const Observation& obs, double camera_height_m);

/// Height of the camera above the foot [m]: the mounting's, else `camera_height_m`.
double CameraHeightOf(const Observation& obs, double camera_height_m);

}  // namespace crossnav
