// SPDX-License-Identifier: MIT
#include "crossnav/core/observation.h"

#include <numbers>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"

namespace crossnav {
namespace {

using std::numbers::pi;

AgentPose AnyPose(Rng& rng) {
  return {{rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(-3, 3)},
          rng.Uniform(-pi, pi),
          rng.Uniform(-1.2, 1.2)};
}

TEST(FootPoseOf, IsThatOfALevelCameraWithoutAMounting) {
  Rng rng(1);
  for (int i = 0; i < 50; ++i) {
    Observation obs;
    obs.T_world_camera = CameraPose(AnyPose(rng), 0.88);
    const AgentPose foot = FootPoseOf(obs, 0.88);
    const AgentPose expected = AgentPoseOf(obs.T_world_camera, 0.88);
    EXPECT_EQ(foot.p_world, expected.p_world);  // to the last bit
    EXPECT_EQ(foot.yaw_rad, expected.yaw_rad);
    EXPECT_EQ(foot.pitch_rad, expected.pitch_rad);
    EXPECT_EQ(CameraHeightOf(obs, 0.88), 0.88);
  }
}

TEST(FootPoseOf, IsTheBaseOfAnyMounting) {
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    const AgentPose robot = AnyPose(rng), camera_on_base = AnyPose(rng);
    Observation obs;
    obs.T_base_camera = CameraPose(camera_on_base, 0.6);
    Pose T_world_base = Pose::Identity();
    T_world_base.translate(robot.p_world);
    T_world_base.rotate(Eigen::AngleAxisd(robot.yaw_rad, Vector3d::UnitZ()));
    obs.T_world_camera = T_world_base * *obs.T_base_camera;
    const AgentPose foot = FootPoseOf(obs, 5);  // unused height
    EXPECT_NEAR((foot.p_world - robot.p_world).norm(), 0, 1e-12);
    EXPECT_NEAR(WrapAngle(foot.yaw_rad - robot.yaw_rad), 0, 1e-12);
    EXPECT_NEAR(foot.pitch_rad, camera_on_base.pitch_rad, 1e-9);
    EXPECT_NEAR(CameraHeightOf(obs, 5), camera_on_base.p_world.z() + 0.6, 1e-12);
  }
}

TEST(FootPoseOf, ALeaningBaseKeepsItsFoot) {
  Pose T_world_base = Pose::Identity();
  T_world_base.translate(Vector3d(1, 2, 3));
  T_world_base.rotate(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  T_world_base.rotate(Eigen::AngleAxisd(-0.3, Vector3d::UnitY()));  // up a ramp
  Observation obs;
  obs.T_base_camera = CameraPose({Vector3d(0.2, 0.1, 0), 0, 0}, 1.2);
  obs.T_world_camera = T_world_base * *obs.T_base_camera;
  const AgentPose foot = FootPoseOf(obs, 0.88);
  EXPECT_NEAR((foot.p_world - Vector3d(1, 2, 3)).norm(), 0, 1e-12);
  EXPECT_NEAR(foot.yaw_rad, 0.5, 1e-12);
  EXPECT_NEAR(foot.pitch_rad, 0.3, 1e-12);
}

}  // namespace
}  // namespace crossnav
