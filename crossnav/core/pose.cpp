// SPDX-License-Identifier: MIT
#include "crossnav/core/pose.h"

#include <cmath>

namespace crossnav {

Pose CameraPose(const AgentPose& agent, double camera_height_m) {
  const double cy = std::cos(agent.yaw_rad), sy = std::sin(agent.yaw_rad);
  const double cp = std::cos(agent.pitch_rad), sp = std::sin(agent.pitch_rad);
  Pose T = Pose::Identity();
  T.linear().col(0) = Vector3d(sy, -cy, 0);             // right
  T.linear().col(1) = Vector3d(cy * sp, sy * sp, -cp);  // down
  T.linear().col(2) = Vector3d(cy * cp, sy * cp, sp);   // forward
  T.translation() = agent.p_world + Vector3d(0, 0, camera_height_m);
  return T;
}

AgentPose AgentPoseOf(const Pose& T_world_camera, double camera_height_m) {
  const Vector3d forward = T_world_camera.linear().col(2);
  const Vector3d right = T_world_camera.linear().col(0);
  AgentPose agent;
  agent.p_world = T_world_camera.translation() - Vector3d(0, 0, camera_height_m);
  agent.yaw_rad = std::atan2(right.x(), -right.y());  // defined even when looking straight up
  agent.pitch_rad = std::atan2(forward.z(), std::hypot(forward.x(), forward.y()));
  return agent;
}

double WrapAngle(double angle_rad) {
  constexpr double kTwoPi = 6.283185307179586;
  const double wrapped = std::remainder(angle_rad, kTwoPi);
  return wrapped <= -kTwoPi / 2 ? wrapped + kTwoPi : wrapped;
}

bool IsValidPose(const Pose& pose) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d R = pose.linear();
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-3 &&
         R.determinant() > 0;
}

}  // namespace crossnav
