// SPDX-License-Identifier: MIT
#include "crossnav/policy/approach.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "crossnav/policy/clusters.h"
#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelState;
using test::AddGround;
using test::SetState;

constexpr double kCamera_m = 0.88;

std::vector<VoxelKey> Block(int x, int y, int z, int side) {
  std::vector<VoxelKey> keys;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k) keys.push_back({x + i, y + j, z + k});
  return keys;
}

/// Ground of 4 x 4 m with its top at 0 and an object of 0.4 m in its middle.
struct ApproachRoom {
  VoxelMap map;
  std::vector<VoxelKey> object = Block(18, 18, 0, 4);
  ApproachRoom() {
    AddGround(map, 0, 0, 40, 40, -1);
    for (const VoxelKey& key : object) SetState(map, key, VoxelState::kOccupied);
  }
};

TEST(Viewpoints, AreAllFreeStandingPlacesInRangeWhereSightIsNotAsked) {
  ApproachRoom room;
  ApproachConfig config;
  config.min_visibility = 0;
  config.stray_share = 0;
  const auto viewpoints = Viewpoints(room.map, room.object, 1.23, config, kCamera_m);
  std::vector<VoxelKey> expected;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) {
      if (room.map.StateAt({x, y, 0}) != VoxelState::kTraversable) continue;
      double nearest = 1e9;
      for (const VoxelKey& key : room.object)
        nearest = std::min(nearest, 0.1 * std::hypot(x - key.x, y - key.y));
      // On the ground the height counts from the foot to the lowest voxel's centre: nothing.
      if (nearest <= 1.23) expected.push_back({x, y, 0});
    }
  // Places on the object itself count, too; this test needs the ground around it.
  std::vector<VoxelKey> ground;
  for (const VoxelKey& key : viewpoints)
    if (key.z == 0) ground.push_back(key);
  EXPECT_EQ(ground, expected);
  EXPECT_TRUE(std::is_sorted(viewpoints.begin(), viewpoints.end()));
}

TEST(Viewpoints, AreNoneBehindAWall) {
  ApproachRoom room;
  for (int y = 0; y < 40; ++y)
    for (int z = 0; z < 25; ++z) SetState(room.map, {14, y, z}, VoxelState::kOccupied);
  const auto viewpoints = Viewpoints(room.map, room.object, 1.3, {}, kCamera_m);
  EXPECT_GT(viewpoints.size(), 100u);
  for (const VoxelKey& key : viewpoints) EXPECT_GT(key.x, 14);
}

// Regression: a stove was looked for from behind the wall that it stands at, whose surface no frame
// had shown (house 8106 of crossnav-lifelong-1-val).
TEST(ViewTest, HidesAnObjectBehindUnobservedSpaceOnDemand) {
  ApproachRoom room;
  for (int x = 12; x < 15; ++x)
    for (int y = 0; y < 40; ++y)
      for (int z = 0; z < 25; ++z) SetState(room.map, {x, y, z}, VoxelState::kUnknown);
  ViewTest view(room.map, room.object, 1.3, {}, kCamera_m);
  EXPECT_TRUE(view.IsView({10, 20, 0}));
  EXPECT_TRUE(view.IsView({30, 20, 0}));
  view.AskForSeenAir();
  EXPECT_FALSE(view.IsView({10, 20, 0}));
  EXPECT_TRUE(view.IsView({30, 20, 0}));
}

TEST(Viewpoints, AreNotInflatedNorOutOfRange) {
  ApproachRoom room;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 20; ++x) SetState(room.map, {x, y, 0}, VoxelState::kTraversable, true);
  for (const VoxelKey& key : Viewpoints(room.map, room.object, 1.3, {}, kCamera_m))
    EXPECT_FALSE(room.map.At(key).is_inflated);
  EXPECT_TRUE(Viewpoints(room.map, {}, 1.3, {}, kCamera_m).empty());
}

TEST(Viewpoints, PlacesThatWereTriedAreNotOfferedAgain) {
  ApproachRoom room;
  const Vector3d tried(1.05, 2.05, 0);
  const auto viewpoints = Viewpoints(room.map, room.object, 1.3, {}, kCamera_m, {tried});
  EXPECT_FALSE(viewpoints.empty());
  for (const VoxelKey& key : viewpoints)
    EXPECT_GE((CenterOf(key, 0.1) - tried).head<2>().norm(), 0.4 - 1e-9);
}

TEST(DistanceToObject, IsMeasuredFromTheUprightAxis) {
  EXPECT_NEAR(DistanceToObject({{10, 0, 5}}, {0.05, 0.05, 0}, kCamera_m, 0.1, 0), 1.0, 1e-9);
  EXPECT_NEAR(DistanceToObject({{0, 0, 18}}, {0.05, 0.05, 0}, kCamera_m, 0.1, 0), 1.85 - 0.88,
              1e-9);
  EXPECT_NEAR(DistanceToObject({{3, 0, -5}}, {0.05, 0.05, 0}, kCamera_m, 0.1, 0),
              std::hypot(0.3, 0.45), 1e-9);
}

TEST(DistanceToObject, LeavesOutTheShareOfVoxelsThatMayBeStrays) {
  std::vector<VoxelKey> sofa;
  for (int y = 0; y < 19; ++y) sofa.push_back({15, y, 3});
  sofa.push_back({10, 0, 3});  // the corner of a table before it
  std::sort(sofa.begin(), sofa.end());
  const Vector3d p_foot(0.05, 0.05, 0);
  EXPECT_NEAR(DistanceToObject(sofa, p_foot, kCamera_m, 0.1, 0), 1.0, 1e-9);
  EXPECT_NEAR(DistanceToObject(sofa, p_foot, kCamera_m, 0.1, 0.1), 1.5, 1e-9);
  EXPECT_NEAR(DistanceToObject({{10, 0, 5}}, p_foot, kCamera_m, 0.1, 0.9), 1.0, 1e-9);
  EXPECT_TRUE(std::isinf(DistanceToObject({}, p_foot, kCamera_m, 0.1, 0.1)));
}

TEST(DistanceToObject, IsWithinAgreesWithIt) {
  Rng rng(7);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<VoxelKey> object;
    for (int i = rng.Int(1, 40); i > 0; --i)
      object.push_back({rng.Int(-20, 20), rng.Int(-20, 20), rng.Int(-5, 20)});
    const Vector3d p_foot(rng.Uniform(-2, 2), rng.Uniform(-2, 2), 0);
    const double share = rng.Uniform(0, 0.9), range_m = rng.Uniform(0.1, 3);
    EXPECT_EQ(IsWithin(range_m, object, p_foot, kCamera_m, 0.1, share),
              DistanceToObject(object, p_foot, kCamera_m, 0.1, share) <= range_m);
  }
}

TEST(AimPoint, OfALongObjectIsItsNearEnd) {
  std::vector<VoxelKey> sofa;
  for (int x = 0; x < 30; ++x) sofa.push_back({x, 0, 3});
  const Vector3d p = AimPoint(sofa, {-0.5, 0.05, 0}, 0.1);
  EXPECT_LT(p.x(), 0.7);
  EXPECT_GT(p.x(), 0.3);
}

TEST(CenteringAction, BringsEveryTargetNearTheImageCentreAndThenStops) {
  Rng rng(5);
  const ActionConfig action;
  for (int trial = 0; trial < 500; ++trial) {
    AgentPose agent;
    agent.p_world = {rng.Uniform(-3, 3), rng.Uniform(-3, 3), rng.Uniform(-1, 1)};
    agent.yaw_rad = rng.Uniform(-3.14, 3.14);
    agent.pitch_rad = DegToRad(30 * rng.Int(-2, 2));
    const Vector3d p =
        agent.p_world + Vector3d(rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(-0.3, 2.5));
    int steps = 0;
    while (const auto next = CenteringAction(agent, p, kCamera_m, action)) {
      ASSERT_LT(++steps, 12) << "trial " << trial;
      const double turn = DegToRad(30);
      if (*next == Action::kTurnLeft) agent.yaw_rad = WrapAngle(agent.yaw_rad + turn);
      if (*next == Action::kTurnRight) agent.yaw_rad = WrapAngle(agent.yaw_rad - turn);
      if (*next == Action::kLookUp) agent.pitch_rad += turn;
      if (*next == Action::kLookDown) agent.pitch_rad -= turn;
      ASSERT_LE(std::abs(agent.pitch_rad), DegToRad(60) + 1e-9);
    }
    const Vector3d p_camera = CameraPose(agent, kCamera_m).inverse() * p;
    const Vector3d d = p - agent.p_world - Vector3d(0, 0, kCamera_m);
    const double elevation = std::atan2(d.z(), d.head<2>().norm());
    if (std::abs(elevation) > DegToRad(60) || d.head<2>().norm() < 0.06) continue;
    EXPECT_GT(p_camera.z(), 0);
    EXPECT_LE(std::abs(elevation - agent.pitch_rad), DegToRad(15) + 1e-5);
    const double yaw_error = WrapAngle(std::atan2(d.y(), d.x()) - agent.yaw_rad);
    EXPECT_LE(std::abs(yaw_error), DegToRad(15) + 1e-5);
  }
}

/// A frame in which every check passes: a cube one metre ahead at eye height.
struct Frame {
  LivePoi poi;
  std::vector<Sighting> sightings;
  Observation obs;
  AgentPose agent;

  Frame() {
    Place(9);
    obs.camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
    obs.depth_m = DepthImage(64, 64, 0.95F);
    Turn(0);
  }
  void Place(int x) {
    poi.voxels = Block(x, -1, 8, 3);
    poi.p_center_world = CentroidOf(poi.voxels, 0.1);
    Sighting sighting;
    sighting.voxels = poi.voxels;
    sighting.p_center_world = poi.p_center_world;
    sighting.confidence = 0.9;
    sighting.mask_quality = 0.9;
    sightings = {sighting};
  }
  void Turn(double yaw_deg) {
    agent.yaw_rad = DegToRad(yaw_deg);
    obs.T_world_camera = CameraPose(agent, kCamera_m);
  }
  Verification Check() const { return Verify(poi, sightings, {obs, agent, kCamera_m}, {}, 0.1); }
};

TEST(Verify, PassesWhenEveryCheckDoes) {
  const Verification result = Frame().Check();
  EXPECT_TRUE(result.passed) << result.failed_check;
  EXPECT_EQ(result.failed_check, "");
  // The two nearest voxels are at the camera's height; the next ones are 0.07 m above it.
  EXPECT_NEAR(result.distance_m, std::hypot(0.95, 0.05, 0.07), 1e-9);
  EXPECT_NEAR(result.confidence, 0.9, 1e-12);
  EXPECT_EQ(result.visibility, 1);
}

TEST(Verify, MeasuresFromTheFootItIsGiven) {
  Frame frame;
  frame.agent.p_world.x() -= 0.2;  // the camera stays where it is, ahead of the foot
  EXPECT_NEAR(frame.Check().distance_m, std::hypot(1.15, 0.05, 0.07), 1e-9);
  EXPECT_TRUE(frame.Check().passed);
  frame.agent.p_world.x() -= 0.3;
  EXPECT_EQ(frame.Check().failed_check, "distance");
}

TEST(Verify, NamesTheOneCheckThatFails) {
  const auto expect = [](const Frame& frame, const std::string& check) {
    const Verification result = frame.Check();
    EXPECT_FALSE(result.passed);
    EXPECT_EQ(result.failed_check, check);
  };
  Frame frame;
  frame.sightings.clear();
  expect(frame, "not detected");
  frame = Frame();
  for (VoxelKey& key : frame.sightings[0].voxels) key.y += 20;
  frame.sightings[0].p_center_world.y() += 2;
  expect(frame, "not detected");  // another object is visible
  frame = Frame();
  frame.sightings[0].confidence = 0.69;
  expect(frame, "confidence");
  frame = Frame();
  frame.sightings[0].mask_quality = 0.49;
  expect(frame, "mask quality");
  frame = Frame();
  frame.obs.depth_m = DepthImage(64, 64, 0.2F);
  expect(frame, "visibility");  // something stands right before the camera
  frame = Frame();
  frame.Turn(38);
  expect(frame, "viewing direction");
  frame = Frame();
  frame.Place(13);
  frame.obs.depth_m = DepthImage(64, 64, 1.35F);
  expect(frame, "distance");
}

TEST(Verify, TheMostConfidentSightingOfTheObjectCounts) {
  Frame frame;
  frame.sightings.push_back(frame.sightings[0]);
  frame.sightings[0].confidence = 0.5;
  EXPECT_TRUE(frame.Check().passed);
}

}  // namespace
}  // namespace crossnav::policy
