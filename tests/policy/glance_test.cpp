// SPDX-License-Identifier: MIT
#include "crossnav/policy/glance.h"

#include <gtest/gtest.h>

#include <cmath>

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

constexpr double kHfov_rad = M_PI / 2;
const VoxelKey kPlace{10, 10, 1};

/// A room of 20 x 20 columns with walls around, but for the side y = 20 where `is_open`.
planner::GroundMap Room(bool is_open) {
  VoxelMap map;
  AddGround(map, 0, 0, 20, 20, 0);
  for (int i = -1; i <= 20; ++i)
    for (int z = 0; z <= 16; ++z) {
      for (const int edge : {-1, 20}) SetState(map, {edge, i, z}, VoxelState::kOccupied);
      SetState(map, {i, -1, z}, VoxelState::kOccupied);
      if (!is_open) SetState(map, {i, 20, z}, VoxelState::kOccupied);
    }
  return GroundOf(map);
}

AgentPose Facing(double yaw_rad) {
  AgentPose pose;
  pose.p_world = Vector3d(1.05, 1.05, 0.1);
  pose.yaw_rad = yaw_rad;
  return pose;
}

TEST(Glance, TurnsToTheOpenSide) {
  const auto heading_rad = GlanceHeading(Room(true), kPlace, Facing(0), kHfov_rad, {}, {});
  ASSERT_TRUE(heading_rad);
  EXPECT_NEAR(*heading_rad, M_PI / 2, 1e-9);
}

TEST(Glance, NotWhereEverythingWasSeen) {
  EXPECT_FALSE(GlanceHeading(Room(false), kPlace, Facing(0), kHfov_rad, {}, {}));
}

TEST(Glance, NotForLittleNorWhereTheAgentLooksAlready) {
  ExploreConfig config;
  config.glance_m2 = 100;
  EXPECT_FALSE(GlanceHeading(Room(true), kPlace, Facing(0), kHfov_rad, {}, config));
  EXPECT_FALSE(GlanceHeading(Room(true), kPlace, Facing(M_PI / 2), kHfov_rad, {}, {}));
}

// Ground that stays unseen after a look must not delay the agent.
TEST(Glance, NotTwiceFromTheSamePlace) {
  LookedAlong looked;
  looked.Add(Facing(M_PI / 2), kHfov_rad);
  EXPECT_TRUE(looked.Has(Facing(0).p_world, 3));
  EXPECT_TRUE(looked.Has(Facing(0).p_world, 4));
  EXPECT_FALSE(looked.Has(Facing(0).p_world, 5));
  EXPECT_FALSE(looked.Has(Vector3d(5, 5, 0.1), 3));
  ExploreConfig config;
  config.glance_m2 = 5;  // the corners of the open side show less
  EXPECT_FALSE(GlanceHeading(Room(true), kPlace, Facing(0), kHfov_rad, looked, config));
}

TEST(Glance, ANarrowPictureShowsItsOwnSector) {
  LookedAlong looked;
  looked.Add(Facing(-M_PI / 2), 0.5);
  EXPECT_TRUE(looked.Has(Facing(0).p_world, 9));
  EXPECT_FALSE(looked.Has(Facing(0).p_world, 8));
  EXPECT_FALSE(looked.Has(Facing(0).p_world, 10));
}

}  // namespace
}  // namespace crossnav::policy
