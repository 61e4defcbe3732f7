// SPDX-License-Identifier: MIT
#include "crossnav/core/observation.h"

#include <cmath>

namespace crossnav {

AgentPose FootPoseOf(const Observation& obs, double camera_height_m) {
  AgentPose agent = AgentPoseOf(obs.T_world_camera, camera_height_m);
  if (!obs.T_base_camera) return agent;
  const Pose T_world_base = obs.T_world_camera * obs.T_base_camera->inverse();
  const Vector3d ahead = T_world_base.linear().col(0);
  agent.p_world = T_world_base.translation();
  agent.yaw_rad = std::atan2(ahead.y(), ahead.x());
  return agent;
}

double CameraHeightOf(const Observation& obs, double camera_height_m) {
  return obs.T_base_camera ? obs.T_base_camera->translation().z() : camera_height_m;
}

}  // namespace crossnav
