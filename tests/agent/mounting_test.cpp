// SPDX-License-Identifier: MIT
// The same house seen by cameras that are mounted otherwise, and with colour of another camera.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "agent/two_rooms.h"

namespace crossnav::agent {
namespace {

using test::BoxWalker;
using test::FakeSight;
using test::FakeSuite;
using testing::ClosedRoom;
using testing::CouchSight;
using testing::kCouch;
using testing::RunAgent;
using testing::SmallConfig;
using testing::TwoRooms;

/// A camera `ahead_m` before the foot, turned by `yaw_deg` to the left.
struct Mount {
  double ahead_m = 0, yaw_deg = 0, height_m = 0.88;
};

/// View of a walker's robot with such a camera, at the walker's pitch.
Observation Look(const BoxWalker& walker, const Mount& mount) {
  Observation obs = walker.Look();
  obs.T_base_camera =
      CameraPose({Vector3d(mount.ahead_m, 0, 0), DegToRad(mount.yaw_deg), walker.pose.pitch_rad},
                 mount.height_m);
  Pose T_world_base = Pose::Identity();
  T_world_base.translate(walker.pose.p_world);
  T_world_base.rotate(Eigen::AngleAxisd(walker.pose.yaw_rad, Vector3d::UnitZ()));
  obs.T_world_camera = T_world_base * *obs.T_base_camera;
  obs.depth_m = crossnav::testing::RenderDepth(walker.rooms, obs.camera, obs.T_world_camera);
  return obs;
}

TEST(Mounting, ACameraAheadAndTurnedGivesTheSameFootPath) {
  Agent plain(SmallConfig(), FakeSuite({})), mounted(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(plain.SetGoal("bed").has_value());
  ASSERT_TRUE(mounted.SetGoal("bed").has_value());
  BoxWalker walker = TwoRooms();
  for (int i = 0; i < 60; ++i) {
    const auto a = plain.Step(walker.Look());
    const auto b = mounted.Step(Look(walker, {0.2, 90, 0.6}));
    ASSERT_TRUE(a.has_value());
    ASSERT_TRUE(b.has_value()) << b.error().Message();
    const AgentPose &foot = a->trace.agent, &other = b->trace.agent;
    ASSERT_NEAR((foot.p_world - other.p_world).norm(), 0, 1e-9) << i;
    ASSERT_NEAR(WrapAngle(foot.yaw_rad - other.yaw_rad), 0, 1e-9) << i;
    ASSERT_NEAR(foot.pitch_rad, other.pitch_rad, 1e-9) << i;
    if (!a->all_explored) walker.Do(a->action);
  }
  EXPECT_GT((walker.pose.p_world - TwoRooms().pose.p_world).norm(), 1);
}

/// Finds the couch; the foot of every step is the walker's.
void ExpectCouchFound(const Mount& mount, const Config& config) {
  Agent agent(config, FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  Action action = Action::kTurnLeft;
  int steps = 0;
  for (; steps < 400 && action != Action::kStop; ++steps) {
    const auto result = agent.Step(Look(walker, mount));
    ASSERT_TRUE(result.has_value()) << result.error().Message();
    ASSERT_NEAR((result->trace.agent.p_world - walker.pose.p_world).norm(), 0, 1e-9);
    ASSERT_FALSE(result->all_explored) << "after " << steps;
    action = result->action;
    walker.Do(action);
  }
  EXPECT_EQ(action, Action::kStop) << "after " << steps;
  EXPECT_LE(kCouch.HorizontalDistance(walker.pose.p_world), 1.30);
}

TEST(Mounting, TheGoalIsFoundByALowCameraAhead) {
  ExpectCouchFound({0.2, 0, 0.6}, SmallConfig());
}

TEST(Mounting, ATurnedCameraIsTurnedToTheGoal) {
  ExpectCouchFound({0.1, 90, 0.88}, SmallConfig());  // which is never seen ahead of the robot
}

TEST(Mounting, ThePapersPolicyFindsTheGoalWithIt) {
  Config config = SmallConfig();
  config.policy.profile = "paper";
  ExpectCouchFound({0.2, 0, 0.6}, config);
}

TEST(Mounting, TheHeightOfTheMountingHoldsOnlyWhereItIsGiven) {
  Agent agent(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  const BoxWalker walker = ClosedRoom();
  ASSERT_TRUE(agent.Step(Look(walker, {0, 0, 0.5})).has_value());
  EXPECT_EQ(agent.config().sensor.camera_height_m, 0.88);
  const auto plain = agent.Step(walker.Look());
  ASSERT_TRUE(plain.has_value());
  EXPECT_EQ(plain->trace.agent.p_world, walker.pose.p_world);
}

TEST(Mounting, AnInvalidMountingIsAnErrorThatNamesItsKey) {
  Agent agent(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  const Observation good = Look(ClosedRoom(), {0.2, 0, 0.6});
  const auto expect_bad = [&](const Pose& T_base_camera) {
    Observation bad = good;
    bad.T_base_camera = T_base_camera;
    const auto result = agent.Step(bad);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().where, "observation.T_base_camera");
  };
  const auto changed = [&](auto&& change) {
    Pose T = *good.T_base_camera;
    change(T);
    return T;
  };
  expect_bad(changed([](Pose& T) { T.translation().x() = std::nan(""); }));
  expect_bad(changed([](Pose& T) { T.linear() *= 1.1; }));
  expect_bad(changed([](Pose& T) { T.linear().col(0) *= -1; }));
  expect_bad(changed([](Pose& T) { T.translation().z() = 0; }));
  expect_bad(changed([](Pose& T) { T.translation().z() = 5.1; }));
  expect_bad(changed([](Pose& T) { T.translation().y() = -6; }));
  // The inverse transform, and a camera of ROS's other frame (x ahead) instead of the optical
  // frame.
  expect_bad(good.T_base_camera->inverse());
  expect_bad(Pose(Eigen::Translation3d(0.2, 0, 0.6)));
  EXPECT_EQ(agent.map().Stats().known, 0);
  EXPECT_TRUE(agent.Step(good).has_value());
}

/// The walker's picture with colour of its own: 96 x 80 pixels from 6 cm beside.
Observation WithColourCamera(const BoxWalker& walker) {
  Observation obs = walker.Look();
  obs.rgb_camera = IntrinsicsFromHfov(96, 80, DegToRad(70));
  obs.rgb = RgbImage(96, 80, {1, 2, 3});
  obs.T_camera_rgb.translation().x() = 0.06;
  return obs;
}

TEST(ColourCamera, PerceptionSeesColourOnTheGridOfDepth) {
  std::vector<Observation> seen;
  FakeSight sight;
  sight.detect = [&](const Observation& obs, std::string_view) {
    seen.push_back(obs);
    return std::vector<perception::Detection>{};
  };
  Agent agent(SmallConfig(), FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  const auto result = agent.Step(WithColourCamera(ClosedRoom()));
  ASSERT_TRUE(result.has_value()) << result.error().Message();
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen[0].rgb.width, 64);
  EXPECT_EQ(seen[0].rgb.height, 64);
  EXPECT_EQ(seen[0].rgb_camera, CameraIntrinsics{});
  EXPECT_EQ(seen[0].rgb.At(32, 32), (Rgb8{1, 2, 3}));
  EXPECT_EQ(seen[0].rgb.At(0, 32), Rgb8{});  // 90 degrees against 70
}

TEST(ColourCamera, ThatOfDepthGivesTheSameTracesByteForByte) {
  std::vector<std::vector<std::string>> traces(2);
  for (const bool is_said : {false, true}) {
    Agent agent(SmallConfig(), FakeSuite(CouchSight()));
    ASSERT_TRUE(agent.SetGoal("couch").has_value());
    BoxWalker walker = TwoRooms();
    for (int i = 0; i < 60; ++i) {
      Observation obs = walker.Look();
      if (is_said) obs.rgb_camera = obs.camera;
      const auto result = agent.Step(obs);
      ASSERT_TRUE(result.has_value());
      traces[is_said].push_back(ToJson(result->trace));
      walker.Do(result->action);
    }
  }
  EXPECT_EQ(traces[0], traces[1]);
}

TEST(ColourCamera, AnInvalidColourCameraIsAnErrorThatNamesItsKey) {
  Agent agent(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  const auto where = [&](auto&& change) {
    Observation bad = WithColourCamera(ClosedRoom());
    change(bad);
    const auto result = agent.Step(bad);
    return result ? std::string() : result.error().where;
  };
  EXPECT_EQ(where([](Observation& o) { o.rgb = RgbImage(64, 64); }), "observation.rgb");
  EXPECT_EQ(where([](Observation& o) { o.rgb = RgbImage(); }), "observation.rgb");
  EXPECT_EQ(where([](Observation& o) { o.rgb_camera.height_px = 81; }), "observation.rgb");
  EXPECT_EQ(where([](Observation& o) { o.rgb_camera.fx = 0; }), "observation.rgb_camera");
  EXPECT_EQ(where([](Observation& o) { o.rgb_camera.fy = -3; }), "observation.rgb_camera");
  EXPECT_EQ(where([](Observation& o) { o.rgb_camera.cx = std::nan(""); }),
            "observation.rgb_camera");
  EXPECT_EQ(where([](Observation& o) { o.T_camera_rgb.linear() *= 2; }),
            "observation.T_camera_rgb");
  EXPECT_EQ(where([](Observation& o) {
              o.T_camera_rgb.translation().z() = std::numeric_limits<double>::infinity();
            }),
            "observation.T_camera_rgb");
  EXPECT_EQ(where([](Observation& o) { o.depth_m = DepthImage(63, 64); }), "observation.depth_m");
  // An offset without a camera would be ignored.
  EXPECT_EQ(where([](Observation& o) {
              o.rgb = RgbImage(64, 64);
              o.rgb_camera = {};
            }),
            "observation.rgb_camera");
  EXPECT_EQ(agent.map().Stats().known, 0);
  EXPECT_EQ(where([](Observation&) {}), "");
}

}  // namespace
}  // namespace crossnav::agent
