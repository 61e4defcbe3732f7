// SPDX-License-Identifier: MIT
#include "crossnav/policy/steering.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;
using geometry::VoxelState;
using test::AddGround;
using test::SetState;

/// Ground of 6 x 6 m with its top at 0.
VoxelMap Hall() {
  VoxelMap map;
  AddGround(map, -30, -30, 30, 30, -1);
  return map;
}

void AddColumn(VoxelMap& map, int x, int y) {
  for (int z = 0; z < 18; ++z) SetState(map, {x, y, z}, VoxelState::kOccupied);
}

AgentPose At(double x, double y, double yaw_deg) {
  return {Vector3d(x, y, 0), DegToRad(yaw_deg), 0};
}

Vector3d AheadOf(const AgentPose& agent, double distance_m, double turn_deg = 0) {
  const double yaw = agent.yaw_rad + DegToRad(turn_deg);
  return agent.p_world + distance_m * Vector3d(std::cos(yaw), std::sin(yaw), 0);
}

TEST(SteerTowards, TurnsInTheShorterDirectionAndWalksWhenItFaces) {
  const VoxelMap map = Hall();
  for (int turn_deg = -160; turn_deg <= 160; turn_deg += 10) {
    const AgentPose agent = At(0.05, 0.05, 40);
    const Action next = SteerTowards(map, agent, AheadOf(agent, 1.5, turn_deg), nullptr, {});
    const Action expected = std::abs(turn_deg) < 15 ? Action::kMoveForward
                            : turn_deg > 0          ? Action::kTurnLeft
                                                    : Action::kTurnRight;
    EXPECT_EQ(NameOf(next), NameOf(expected)) << turn_deg;
  }
}

TEST(SteerTowards, DoesNotWalkIntoAWall) {
  VoxelMap map = Hall();
  for (int y = -30; y < 30; ++y) AddColumn(map, 3, y);
  // Facing the wall at 0.25 m: the next step would touch it.
  EXPECT_NE(SteerTowards(map, At(0.05, 0.05, 0), {2, 0.05, 0}, nullptr, {}), Action::kMoveForward);
  EXPECT_EQ(SteerTowards(map, At(-1, 0.05, 0), {2, 0.05, 0}, nullptr, {}), Action::kMoveForward);
}

TEST(SteerTowards, GoesRoundATemporaryObstacle) {
  const VoxelMap map = Hall();
  const AgentPose agent = At(0.05, 0.05, 0);
  const std::set<VoxelKey> obstacles{{1, 0, 0}, {3, 0, 0}};
  EXPECT_EQ(SteerTowards(map, agent, {2, 0.05, 0}, nullptr, {}), Action::kMoveForward);
  EXPECT_NE(SteerTowards(map, agent, {2, 0.05, 0}, &obstacles, {}), Action::kMoveForward);
}

TEST(ClearanceAt, IsTheDistanceToTheNearestBlockingColumn) {
  Rng rng(3);
  VoxelMap map = Hall();
  std::vector<VoxelKey> columns;
  for (int i = 0; i < 60; ++i) columns.push_back({rng.Int(-25, 25), rng.Int(-25, 25), 0});
  for (const VoxelKey& key : columns) AddColumn(map, key.x, key.y);
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3d p(rng.Uniform(-2, 2), rng.Uniform(-2, 2), 0);
    double nearest = 0.25;
    for (const VoxelKey& key : columns) {
      const double dx = std::max({0.1 * key.x - p.x(), 0.0, p.x() - 0.1 * (key.x + 1)});
      const double dy = std::max({0.1 * key.y - p.y(), 0.0, p.y() - 0.1 * (key.y + 1)});
      nearest = std::min(nearest, std::hypot(dx, dy));
    }
    if (nearest == 0) continue;  // inside a column: no ground of its own
    EXPECT_NEAR(ClearanceAt(map, p), nearest, 1e-9) << "trial " << trial;
  }
}

TEST(ClearanceAt, LowStepsAndHighLintelsDoNotBlock) {
  VoxelMap map = Hall();
  for (int z = 0; z < 3; ++z) SetState(map, {1, 0, z}, VoxelState::kOccupied);
  SetState(map, {0, 1, 15}, VoxelState::kOccupied);
  EXPECT_EQ(ClearanceAt(map, {0.05, 0.05, 0}), 0.25);
  SetState(map, {1, 0, 3}, VoxelState::kOccupied);
  EXPECT_NEAR(ClearanceAt(map, {0.05, 0.05, 0}), 0.05, 1e-9);
}

TEST(VisibleWaypoint, IsFarOnAStraightPathAndNearRoundACorner) {
  VoxelMap map = Hall();
  std::vector<VoxelKey> straight, corner;
  for (int x = 0; x <= 25; ++x) straight.push_back({x, 0, 0});
  const Vector3d p_far = VisibleWaypoint(map, straight, {0.05, 0.05, 0}, {});
  EXPECT_GT(p_far.x(), 1.35);
  EXPECT_LE(p_far.x(), 1.56);
  for (int x = 0; x <= 8; ++x) corner.push_back({x, 0, 0});
  for (int y = 1; y <= 12; ++y) corner.push_back({8, y, 0});
  for (int x = 1; x <= 7; ++x)
    for (int y = 1; y <= 12; ++y) AddColumn(map, x, y);
  const Vector3d p_near = VisibleWaypoint(map, corner, {0.05, 0.05, 0}, {});
  EXPECT_GT(p_near.x(), 0.7);
  EXPECT_LT(p_near.y(), 0.3);
}

TEST(PitchTowards, StepsTowardsTheWantedPitchWithinHalfAStep) {
  AgentPose agent;
  EXPECT_FALSE(PitchTowards(agent, DegToRad(15), {}).has_value());
  EXPECT_EQ(PitchTowards(agent, DegToRad(16), {}), Action::kLookUp);
  EXPECT_EQ(PitchTowards(agent, DegToRad(-30), {}), Action::kLookDown);
}

/// Heading after the turns of `actions`.
double HeadingAfter(double yaw_rad, const std::vector<Action>& actions) {
  for (const Action action : actions) {
    if (action == Action::kTurnLeft) yaw_rad += DegToRad(30);
    if (action == Action::kTurnRight) yaw_rad -= DegToRad(30);
  }
  return WrapAngle(yaw_rad);
}

TEST(EscapeActions, AvoidTheHeadingsThatWereTried) {
  const VoxelMap map = Hall();
  Rng rng(8);
  for (int trial = 0; trial < 100; ++trial) {
    const AgentPose agent = At(0, 0, 30 * rng.Int(-5, 6));
    std::vector<double> tried;
    for (int i = rng.Int(1, 8); i > 0; --i)
      tried.push_back(agent.yaw_rad + DegToRad(30) * rng.Int(-5, 6));
    const auto actions = EscapeActions(map, agent, tried, {});
    ASSERT_FALSE(actions.empty());
    EXPECT_EQ(actions.back(), Action::kMoveForward);
    EXPECT_LE(actions.size(), 7u);
    const double heading = HeadingAfter(agent.yaw_rad, actions);
    for (const double yaw : tried) EXPECT_GT(std::abs(WrapAngle(heading - yaw)), DegToRad(15));
  }
}

TEST(EscapeActions, LeaveADeadEndThroughItsOpenSide) {
  VoxelMap map;
  AddGround(map, -12, -2, 3, 3, -1);  // open towards -x only
  const auto actions = EscapeActions(map, At(0.05, 0.05, 0), {0}, {});
  EXPECT_NEAR(std::abs(HeadingAfter(0, actions)), DegToRad(180), 1e-9);
}

TEST(BumpMonitor, MarksTheObstacleAheadAfterTwoBumps) {
  BumpMonitor bumps;
  const AgentPose agent = At(0.05, 0.05, 0);
  EXPECT_FALSE(bumps.Update(agent, 0, {}));
  bumps.Commit(Action::kMoveForward, agent);
  EXPECT_TRUE(bumps.Update(agent, 1, {}));
  EXPECT_TRUE(bumps.obstacles().empty());
  bumps.Commit(Action::kMoveForward, agent);
  EXPECT_TRUE(bumps.Update(agent, 2, {}));
  EXPECT_EQ(bumps.bumps_in_place(), 2);
  EXPECT_EQ(bumps.bumped_yaws(), (std::vector<double>{0, 0}));
  EXPECT_TRUE(bumps.obstacles().contains(VoxelKey{3, 0, 0}));
  EXPECT_FALSE(bumps.obstacles().contains(VoxelKey{-3, 0, 0}));
  EXPECT_FALSE(bumps.obstacles().contains(VoxelKey{0, 0, 0}));
}

TEST(BumpMonitor, TurnsAreNoBumpsAndMovementStartsTheCountAnew) {
  BumpMonitor bumps;
  const AgentPose here = At(0, 0, 0), there = At(0.25, 0, 0);
  bumps.Commit(Action::kTurnLeft, here);
  EXPECT_FALSE(bumps.Update(here, 1, {}));
  bumps.Commit(Action::kMoveForward, here);
  EXPECT_TRUE(bumps.Update(here, 2, {}));
  bumps.Commit(Action::kMoveForward, here);
  EXPECT_FALSE(bumps.Update(there, 3, {}));
  EXPECT_EQ(bumps.bumps_in_place(), 0);
  bumps.Commit(Action::kMoveForward, there);
  EXPECT_TRUE(bumps.Update(there, 4, {}));
  EXPECT_TRUE(bumps.obstacles().empty());
}

TEST(BumpMonitor, ForgetsObstaclesAfterAHundredSteps) {
  BumpMonitor bumps;
  const AgentPose agent = At(0, 0, 0);
  for (int step = 1; step <= 2; ++step) {
    bumps.Commit(Action::kMoveForward, agent);
    bumps.Update(agent, step, {});
  }
  bumps.Update(agent, 102, {});
  EXPECT_FALSE(bumps.obstacles().empty());
  bumps.Update(agent, 103, {});
  EXPECT_TRUE(bumps.obstacles().empty());
}

}  // namespace
}  // namespace crossnav::policy
