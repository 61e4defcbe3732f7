// SPDX-License-Identifier: MIT
#include "crossnav/policy/ground_frontiers.h"

#include <gtest/gtest.h>

#include "support/ground_of.h"
#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelState;
using test::AddGround;
using test::GroundOf;
using test::SetState;

/// A room of 20 x 20 voxels whose walls leave a door of `door` columns at x = 20.
VoxelMap RoomWithDoor(int door) {
  VoxelMap map;
  AddGround(map, 0, 0, 20, 20, 0);
  for (int i = -1; i <= 20; ++i)
    for (int z = 0; z <= 16; ++z) {
      for (const int edge : {-1, 20}) SetState(map, {i, edge, z}, VoxelState::kOccupied);
      SetState(map, {-1, i, z}, VoxelState::kOccupied);
      const bool is_door = i >= 8 && i < 8 + door;
      if (!is_door) SetState(map, {20, i, z}, VoxelState::kOccupied);
    }
  return map;
}

std::vector<Candidate> AllFrontiers(const planner::GroundMap& ground, int side, int z) {
  std::vector<Candidate> all;
  std::set<VoxelKey> visited;
  VoxelKey beyond;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      if (ground.IsStanding({x, y, z}) && !visited.contains({x, y, z}) &&
          IsGroundFrontier(ground, {x, y, z}, &beyond))
        all.push_back(GroundFrontierAround(ground, {x, y, z}, &visited));
  return all;
}

// The lowest layer of air alone fell below five voxels there, and the door was dropped.
TEST(GroundFrontiers, ADoorOfEightyCentimetresIsAFrontierOfItsWidth) {
  const auto ground = GroundOf(RoomWithDoor(8));
  const auto frontiers = AllFrontiers(ground, 20, 1);
  ASSERT_EQ(frontiers.size(), 1u);
  EXPECT_EQ(frontiers.front().size, 8);
  EXPECT_NEAR(frontiers.front().p_focus_world.x(), 2.05, 1e-9);
}

TEST(GroundFrontiers, AClosedRoomHasNone) {
  EXPECT_TRUE(AllFrontiers(GroundOf(RoomWithDoor(0)), 20, 1).empty());
}

TEST(GroundFrontiers, ADropThatWasSeenIsNone) {
  VoxelMap map = RoomWithDoor(8);
  for (int y = 8; y < 16; ++y)
    for (int z = -12; z <= 16; ++z) SetState(map, {20, y, z}, VoxelState::kTraversableFake);
  EXPECT_TRUE(AllFrontiers(GroundOf(map), 20, 1).empty());
}

TEST(GroundFrontiers, AirAboveHiddenFloorIsAFrontier) {
  VoxelMap map = RoomWithDoor(8);
  for (int y = 8; y < 16; ++y)
    for (int z = 0; z <= 16; ++z) SetState(map, {20, y, z}, VoxelState::kTraversableFake);
  EXPECT_EQ(AllFrontiers(GroundOf(map), 20, 1).size(), 1u);
}

TEST(GroundFrontiers, TheyExistOnTreadsAboveTheLevel) {
  VoxelMap map = RoomWithDoor(0);
  // Three treads in the room's corner, the fourth not seen yet.
  for (int step = 0; step < 3; ++step)
    for (int y = 0; y < 8; ++y)
      for (int k = 0; k < 3; ++k)
        for (int z = 1; z <= 2 * (step + 1); ++z)
          SetState(map, {3 * step + k, y, z}, VoxelState::kOccupied);
  for (int x = 9; x < 12; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z <= 8; ++z) SetState(map, {x, y, z}, VoxelState::kUnknown);
  const auto ground = GroundOf(map);
  VoxelKey beyond;
  EXPECT_TRUE(IsGroundFrontier(ground, {8, 4, 7}, &beyond));
  EXPECT_EQ(beyond, (VoxelKey{9, 4, 7}));
}

}  // namespace
}  // namespace crossnav::policy
