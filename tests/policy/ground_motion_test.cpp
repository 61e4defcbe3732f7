// SPDX-License-Identifier: MIT
#include "crossnav/policy/ground_motion.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "crossnav/planner/ground_search.h"
#include "support/ground_of.h"
#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;
using geometry::VoxelState;
using test::AddGround;
using test::GroundOf;
using test::SetState;

std::vector<VoxelKey> PathOver(const planner::GroundMap& ground, const VoxelKey& from,
                               const VoxelKey& to) {
  const planner::PlannerConfig config;
  planner::GroundSearch search(ground, config, from);
  while (const auto key = search.Next())
    if (*key == to) return search.PathTo(to);
  return {};
}

void Do(Action what, AgentPose& pose) {
  if (what == Action::kTurnLeft) pose.yaw_rad += DegToRad(30);
  if (what == Action::kTurnRight) pose.yaw_rad -= DegToRad(30);
  if (what == Action::kMoveForward)
    pose.p_world += 0.25 * Vector3d(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad), 0);
}

TEST(GroundMotion, WalksStraightOnAStraightPath) {
  VoxelMap map;
  AddGround(map, 0, 0, 40, 10, 0);
  const auto ground = GroundOf(map);
  AgentPose agent;
  agent.p_world = {0.55, 0.55, 0.1};
  const auto actions =
      MotionAlong(ground, PathOver(ground, {5, 5, 1}, {30, 5, 1}), agent, {}, {}, {});
  ASSERT_EQ(actions.size(), std::size_t(MotionConfig().horizon_steps));
  EXPECT_EQ(std::count(actions.begin(), actions.end(), Action::kMoveForward), actions.size());
}

TEST(GroundMotion, EndsNoTurnWithoutAStep) {
  VoxelMap map;
  AddGround(map, 0, 0, 40, 10, 0);
  const auto ground = GroundOf(map);
  AgentPose agent;
  agent.p_world = {2.05, 0.55, 0.1};
  agent.yaw_rad = DegToRad(77);
  const auto actions =
      MotionAlong(ground, PathOver(ground, {20, 5, 1}, {2, 5, 1}), agent, {}, {}, {});
  ASSERT_FALSE(actions.empty());
  EXPECT_EQ(actions.back(), Action::kMoveForward);
}

// Regression: the step back up is the front of a seat, so that no cost-to-go reached the agent, and
// it stood still on a flight whose risers a loaded map had lost (house 8106 of
// crossnav-lifelong-1-val).
TEST(GroundMotion, StepsDownWhereNoStepUpIsKnown) {
  VoxelMap map;
  AddGround(map, 0, 0, 12, 12, 0);
  AddGround(map, 12, 0, 13, 12, 3);
  AddGround(map, 13, 0, 24, 12, 4);
  const auto ground = GroundOf(map);
  AgentPose agent;
  agent.p_world = {1.65, 0.55, 0.5};
  agent.yaw_rad = DegToRad(180);
  ASSERT_TRUE(PathOver(ground, {4, 5, 1}, {16, 5, 5}).empty());
  const auto path = PathOver(ground, {16, 5, 5}, {4, 5, 1});
  ASSERT_FALSE(path.empty());
  EXPECT_FALSE(MotionAlong(ground, path, agent, {}, {}, {}).empty());
}

// Regression: the cost-to-go led back up and down another flight beside it, so that the agent
// turned around on the path (house 8107 of crossnav-lifelong-1-val).
TEST(GroundMotion, StaysOnAPathThatHasItsWayBackElsewhere) {
  VoxelMap map;
  AddGround(map, 0, 0, 12, 12, 0);
  AddGround(map, 12, 0, 13, 12, 3);
  AddGround(map, 13, 0, 29, 12, 4);
  AddGround(map, 29, 0, 30, 12, 7);
  AddGround(map, 30, 0, 40, 12, 8);
  const auto path = PathOver(GroundOf(map), {32, 5, 9}, {4, 5, 1});
  ASSERT_FALSE(path.empty());
  AddGround(map, 0, 12, 12, 36, 0);
  AddGround(map, 30, 12, 40, 36, 8);
  for (int tread = 0; tread < 9; ++tread)
    AddGround(map, 12 + 2 * tread, 24, 14 + 2 * tread, 36, tread);
  const auto ground = GroundOf(map);
  ASSERT_FALSE(PathOver(ground, {4, 5, 1}, {32, 5, 9}).empty());
  AgentPose agent;
  agent.p_world = {3.25, 0.55, 0.9};
  agent.yaw_rad = DegToRad(180);
  for (const Action action : MotionAlong(ground, path, agent, {}, {}, {})) Do(action, agent);
  EXPECT_LT(agent.p_world.x(), 2);
  EXPECT_NEAR(agent.p_world.y(), 0.55, 0.4);
}

// Regression: a path that doubles back behind a wall came near its own end: with cost-to-go by
// distance to the path no step helped, and the agent stood still (found in house 8).
TEST(GroundMotion, LeavesAPocketWithAPathThatDoublesBackBehindAThinWall) {
  VoxelMap map;
  AddGround(map, 0, 0, 30, 12, 0);
  for (int x = 0; x < 24; ++x)
    for (int z = 0; z <= 15; ++z) SetState(map, {x, 6, z}, VoxelState::kOccupied);
  const auto ground = GroundOf(map);
  const VoxelKey goal{2, 9, 1};
  AgentPose agent;
  agent.p_world = {0.25, 0.25, 0.1};
  agent.yaw_rad = DegToRad(90);
  for (int step = 0; step < 80; ++step) {
    const auto here = ground.StandingAt(agent.p_world);
    ASSERT_TRUE(here);
    const auto path = PathOver(ground, *here, goal);
    ASSERT_FALSE(path.empty());
    if ((CenterOf(goal, 0.1) - agent.p_world).head<2>().norm() < 0.25) return;
    const auto actions = MotionAlong(ground, path, agent, {}, {}, {});
    ASSERT_FALSE(actions.empty()) << "at " << agent.p_world.transpose();
    Do(actions.front(), agent);
    ASSERT_FALSE(IsSurface(map.StateAt(geometry::KeyOf(agent.p_world + Vector3d(0, 0, 0.5), 0.1))));
  }
  FAIL() << "did not arrive";
}

TEST(GroundMotion, ArrivesInRandomClutterWithoutTouchingIt) {
  int arrived = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    VoxelMap map;
    AddGround(map, 0, 0, 60, 60, 0);
    for (int i = 0; i < 25; ++i) {
      const int x = rng.Int(8, 50), y = rng.Int(8, 50), w = rng.Int(1, 6), h = rng.Int(1, 6);
      for (int dx = 0; dx < w; ++dx)
        for (int dy = 0; dy < h; ++dy)
          for (int z = 1; z <= 12; ++z) SetState(map, {x + dx, y + dy, z}, VoxelState::kOccupied);
    }
    const auto ground = GroundOf(map);
    const VoxelKey goal{56, 56, 1};
    if (PathOver(ground, {3, 3, 1}, goal).empty()) continue;
    AgentPose agent;
    agent.p_world = {0.35, 0.35, 0.1};
    agent.yaw_rad = rng.Uniform(-3, 3);
    for (int step = 0; step < 200; ++step) {
      if ((CenterOf(goal, 0.1) - agent.p_world).head<2>().norm() < 0.25) {
        ++arrived;
        break;
      }
      const auto path = PathOver(ground, *ground.StandingAt(agent.p_world), goal);
      const auto actions = MotionAlong(ground, path, agent, {}, {}, {});
      ASSERT_FALSE(actions.empty()) << seed;
      Do(actions.front(), agent);
      ASSERT_FALSE(
          IsSurface(map.StateAt(geometry::KeyOf(agent.p_world + Vector3d(0, 0, 0.5), 0.1))))
          << seed;
    }
  }
  EXPECT_GE(arrived, 18);
}

/// Walks around the end of a wall until the goal is a step away. Length of the path [m], negative
/// if it does not arrive.
double WalkAroundAWall(std::uint64_t seed, const MotionConfig& config) {
  Rng rng(seed);
  VoxelMap map;
  AddGround(map, 0, 0, 80, 60, 0);
  const int end = rng.Int(20, 40);
  for (int y = 0; y < end; ++y)
    for (int z = 1; z <= 13; ++z)
      for (const int x : {39, 40}) SetState(map, {x, y, z}, VoxelState::kOccupied);
  const auto ground = GroundOf(map);
  const VoxelKey goal{rng.Int(50, 75), rng.Int(5, 20), 1};
  AgentPose agent;
  agent.p_world = {0.1 * rng.Int(5, 30), 0.1 * rng.Int(5, 20), 0.1};
  agent.yaw_rad = rng.Uniform(-M_PI, M_PI);
  double walked_m = 0;
  for (int plan = 0; plan < 200; ++plan) {
    const auto path = PathOver(ground, *ground.StandingAt(agent.p_world), goal);
    for (const Action action : MotionAlong(ground, path, agent, config, {}, {})) {
      if ((CenterOf(goal, 0.1) - agent.p_world).head<2>().norm() < 0.25) return walked_m;
      Do(action, agent);
      walked_m += action == Action::kMoveForward ? 0.25 : 0;
    }
    if ((CenterOf(goal, 0.1) - agent.p_world).head<2>().norm() < 0.25) return walked_m;
  }
  return -1;
}

TEST(GroundMotion, WalksLessWhereTurnsAreCheap) {
  MotionConfig cheap;
  cheap.turn_steps = 0.2;
  double walked_m = 0, cheaply_m = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double a_m = WalkAroundAWall(seed, {}), b_m = WalkAroundAWall(seed, cheap);
    ASSERT_GT(a_m, 0) << seed;
    ASSERT_GT(b_m, 0) << seed;
    walked_m += a_m;
    cheaply_m += b_m;
  }
  EXPECT_LT(cheaply_m, walked_m);
}

/// Whether the agent arrives in the passage behind a wall of one voxel, from before the wall.
bool WalksBehindAThinWall(double x_m, double yaw_rad) {
  VoxelMap map;
  AddGround(map, 0, 0, 30, 11, 0);
  for (int x = 0; x < 24; ++x)
    for (int z = 0; z <= 15; ++z)
      for (const int y : {6, 11}) SetState(map, {x, y, z}, VoxelState::kOccupied);
  const auto ground = GroundOf(map);
  const VoxelKey goal{2, 9, 1};
  AgentPose agent;
  agent.p_world = {x_m, 0.25, 0.1};
  agent.yaw_rad = yaw_rad;
  for (int step = 0; step < 80; ++step) {
    if ((CenterOf(goal, 0.1) - agent.p_world).head<2>().norm() < 0.25) return true;
    const auto here = ground.StandingAt(agent.p_world);
    if (!here) return false;
    const auto actions = MotionAlong(ground, PathOver(ground, *here, goal), agent, {}, {}, {});
    if (actions.empty()) return false;
    Do(actions.front(), agent);
  }
  return false;
}

// Regression: the cost-to-go of a place was read from two columns away, through a wall of one
// voxel: where ground beside walls is cheap, the agent stood before the wall (20 of these 24
// starts).
TEST(GroundMotion, ReadsNoCostToGoThroughAWallOfOneVoxel) {
  for (const double yaw_deg : {0, 90, 180, 270})
    for (int place = 0; place < 6; ++place)
      EXPECT_TRUE(WalksBehindAThinWall(0.25 + 0.3 * place, DegToRad(yaw_deg)))
          << yaw_deg << ' ' << place;
}

}  // namespace
}  // namespace crossnav::policy
