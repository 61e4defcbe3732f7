// SPDX-License-Identifier: MIT
// Poses and the camera's mounting. World: right-handed, z up, metres. Camera: x right, y down,
// z forward. Yaw 0 looks along world +x, counter-clockwise positive; pitch positive looks up.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace crossnav {

using Vector3d = Eigen::Vector3d;
using Vector3f = Eigen::Vector3f;
using Pose = Eigen::Isometry3d;  ///< T_a_b maps points from b to a

/// The robot's own state, as far as walking is concerned.
struct AgentPose {
  Vector3d p_world = Vector3d::Zero();  ///< foot point on the ground [m]
  double yaw_rad = 0;
  double pitch_rad = 0;  ///< of the camera
};

/// Camera-to-world transform of a camera `camera_height_m` above the foot point.
Pose CameraPose(const AgentPose& agent, double camera_height_m);

/// Inverse of CameraPose. The roll of `T_world_camera` is ignored.
AgentPose AgentPoseOf(const Pose& T_world_camera, double camera_height_m);

/// Angle wrapped to (-pi, pi].
double WrapAngle(double angle_rad);

constexpr double DegToRad(double deg) {
  return deg * 0.017453292519943295;
}
constexpr double RadToDeg(double rad) {
  return rad * 57.29577951308232;
}

/// True if every entry is finite and the rotation is orthonormal to 1e-3.
bool IsValidPose(const Pose& pose);

}  // namespace crossnav
