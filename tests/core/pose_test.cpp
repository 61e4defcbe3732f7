// SPDX-License-Identifier: MIT
#include "crossnav/core/pose.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "crossnav/core/camera.h"
#include "crossnav/core/rng.h"

namespace crossnav {
namespace {

using std::numbers::pi;

/// The camera's rotation as two elementary turns of a camera that looks along world +x: the oracle.
Eigen::Matrix3d RotationFromTurns(double yaw_rad, double pitch_rad) {
  Eigen::Matrix3d looking_along_x;
  looking_along_x.col(0) = -Vector3d::UnitY();  // right
  looking_along_x.col(1) = -Vector3d::UnitZ();  // down
  looking_along_x.col(2) = Vector3d::UnitX();   // forward
  // Looking up turns forward towards +z: about the world's -y.
  return (Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) *
          Eigen::AngleAxisd(-pitch_rad, Vector3d::UnitY()))
             .toRotationMatrix() *
         looking_along_x;
}

TEST(CameraPose, EqualsYawThenPitchOfALevelCamera) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    AgentPose agent;
    agent.p_world = {rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(-3, 3)};
    agent.yaw_rad = rng.Uniform(-pi, pi);
    agent.pitch_rad = rng.Uniform(-1.5, 1.5);
    const Pose T = CameraPose(agent, 0.88);
    EXPECT_TRUE(T.linear().isApprox(RotationFromTurns(agent.yaw_rad, agent.pitch_rad), 1e-12));
    EXPECT_TRUE(T.translation().isApprox(agent.p_world + Vector3d(0, 0, 0.88)));
    EXPECT_TRUE(IsValidPose(T));
  }
}

TEST(CameraPose, ComesBackFromItsTransform) {
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    AgentPose agent;
    agent.p_world = {rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(-3, 3)};
    agent.yaw_rad = rng.Uniform(-pi, pi);
    agent.pitch_rad = rng.Uniform(-1.5, 1.5);
    const double height_m = rng.Uniform(0.1, 2);
    const AgentPose back = AgentPoseOf(CameraPose(agent, height_m), height_m);
    EXPECT_NEAR((back.p_world - agent.p_world).norm(), 0, 1e-12);
    EXPECT_NEAR(WrapAngle(back.yaw_rad - agent.yaw_rad), 0, 1e-12);
    EXPECT_NEAR(back.pitch_rad, agent.pitch_rad, 1e-9);
  }
}

TEST(CameraPose, YawSurvivesLookingStraightDown) {
  AgentPose agent;
  agent.yaw_rad = 0.7;
  agent.pitch_rad = -pi / 2;
  EXPECT_NEAR(AgentPoseOf(CameraPose(agent, 1), 1).yaw_rad, 0.7, 1e-9);
}

TEST(WrapAngle, KeepsTheDirectionAndStaysInTheHalfOpenCircle) {
  EXPECT_DOUBLE_EQ(WrapAngle(pi), pi);
  EXPECT_DOUBLE_EQ(WrapAngle(-pi), pi);
  Rng rng(3);
  for (int i = 0; i < 500; ++i) {
    const double angle = rng.Uniform(-40, 40), wrapped = WrapAngle(angle);
    EXPECT_GT(wrapped, -pi);
    EXPECT_LE(wrapped, pi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-9);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-9);
  }
}

TEST(IsValidPose, RefusesNanInfinityScaleAndMirrors) {
  EXPECT_TRUE(IsValidPose(Pose::Identity()));
  Pose pose = Pose::Identity();
  pose.translation().x() = std::nan("");
  EXPECT_FALSE(IsValidPose(pose));
  pose = Pose::Identity();
  pose.linear()(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(IsValidPose(pose));
  pose = Pose::Identity();
  pose.linear() *= 1.01;
  EXPECT_FALSE(IsValidPose(pose));
  pose = Pose::Identity();
  pose.linear()(0, 0) = -1;
  EXPECT_FALSE(IsValidPose(pose));
}

TEST(Camera, NinetyDegreesSeeAsFarAsideAsAhead) {
  const CameraIntrinsics K = IntrinsicsFromHfov(640, 480, DegToRad(90));
  EXPECT_NEAR(K.fx, 320, 1e-9);
  EXPECT_EQ(K.fx, K.fy);
  EXPECT_EQ(K.cx, 319.5);
  EXPECT_EQ(K.cy, 239.5);
  // The image's outer edge lies half a pixel beyond the last pixel's centre.
  const Vector3d edge = BackProjectPixel(K, 639.5, K.cy, 3.0);
  EXPECT_NEAR(edge.x(), 3.0, 1e-9);
  EXPECT_NEAR(edge.y(), 0, 1e-12);
}

TEST(Camera, BackProjectionUndoesThePinholeProjection) {
  Rng rng(4);
  for (int i = 0; i < 300; ++i) {
    const CameraIntrinsics K =
        IntrinsicsFromHfov(rng.Int(8, 900), rng.Int(8, 900), rng.Uniform(0.3, 2.6));
    const Vector3d p(rng.Uniform(-3, 3), rng.Uniform(-3, 3), rng.Uniform(0.2, 9));
    const double u = K.fx * p.x() / p.z() + K.cx, v = K.fy * p.y() / p.z() + K.cy;
    EXPECT_NEAR((BackProjectPixel(K, u, v, p.z()) - p).norm(), 0, 1e-9);
  }
}

TEST(Camera, ThePixelBelowTheCentreSeesTheFloorInFront) {
  const CameraIntrinsics K = IntrinsicsFromHfov(64, 64, DegToRad(90));
  AgentPose agent;
  agent.yaw_rad = pi / 2;  // looks along world +y
  const Vector3d p = CameraPose(agent, 1.0) * BackProjectPixel(K, K.cx, K.cy + K.fy / 2, 2.0);
  EXPECT_NEAR((p - Vector3d(0, 2, 0)).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace crossnav
