// SPDX-License-Identifier: MIT
#include "crossnav/policy/frontier_worth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

/// Ground of 20 x 20 columns; a wall stands around unseen ground of `depth` columns behind x = 20.
VoxelMap RoomBefore(int depth) {
  VoxelMap map;
  AddGround(map, 0, 0, 20, 20, 0);
  for (int y = -1; y <= 20; ++y)
    for (int z = 0; z <= 16; ++z) SetState(map, {20 + depth, y, z}, VoxelState::kOccupied);
  for (int x = 20; x < 20 + depth; ++x)
    for (const int y : {-1, 20})
      for (int z = 0; z <= 16; ++z) SetState(map, {x, y, z}, VoxelState::kOccupied);
  return map;
}

TEST(FrontierWorth, UnseenAreaEndsAtSeenGround) {
  const VoxelKey place{19, 10, 1};
  const double pocket = UnseenBeyond(GroundOf(RoomBefore(5)), place, 4.0);
  EXPECT_NEAR(pocket, 0.5 * 2.1, 0.35);  // half a metre deep, as wide as the room
  const double room = UnseenBeyond(GroundOf(RoomBefore(30)), place, 4.0);
  EXPECT_GT(room, 4 * pocket);
  VoxelMap open;
  AddGround(open, 0, 0, 20, 20, 0);
  // Half a disc of four metres lies beyond the edge of the seen ground.
  EXPECT_NEAR(UnseenBeyond(GroundOf(open), place, 4.0), 0.5 * M_PI * 16, 3);
}

TEST(FrontierWorth, BeforeAWallThatWasSeenThereIsNone) {
  EXPECT_EQ(UnseenBeyond(GroundOf(RoomBefore(0)), {19, 10, 1}, 4.0), 0);
}

TEST(FrontierWorth, ScoringSelectsTheWeights) {
  const auto pocket = GroundOf(RoomBefore(5)), room = GroundOf(RoomBefore(30));
  const VoxelKey place{19, 10, 1};
  const Relevancy nothing;
  ExploreConfig config;
  config.scoring = "nearest";
  EXPECT_EQ(FrontierWorth(pocket, place, nothing, config), 1);
  config.scoring = "area";
  const double worth = FrontierWorth(pocket, place, nothing, config);
  EXPECT_GE(worth, config.least_share);
  EXPECT_LT(worth, 0.3);
  EXPECT_GT(FrontierWorth(room, place, nothing, config), 2 * worth);
  EXPECT_EQ(FrontierWorth(GroundOf(RoomBefore(0)), place, nothing, config), config.least_share);
  config.scoring = "semantic";
  EXPECT_EQ(FrontierWorth(pocket, place, nothing, config), worth);
}

TEST(FrontierWorth, RelevancyOfSurfacesAroundItRaisesTheWorth) {
  memory::SemanticMemory memory({}, 0.1, 2);
  const auto add = [&](int x, std::vector<std::uint16_t> half) {
    for (int k = 0; k < 5; ++k) {
      memory::MemoryRow row;
      row.key = {x + k, 10, 3};
      row.weight = 1;
      row.half = half;
      memory.AppendRow(row);
    }
  };
  constexpr std::uint16_t kOne = 0x3C00;  // half precision
  add(0, {kOne, 0});
  add(60, {0, kOne});
  add(120, {0, kOne});
  Relevancy relevancy;
  relevancy.Refresh(memory, memory.Similarity(std::vector<float>{1, 0}));
  EXPECT_NEAR(relevancy.Around({0.5, 1.0, 0.2}), 1, 1e-6);
  EXPECT_NEAR(relevancy.Around({6.5, 1.0, 0.2}), 0, 1e-6);
  EXPECT_EQ(relevancy.Around({40, 40, 0}), 0);
  relevancy.Refresh(memory, {});
  EXPECT_EQ(relevancy.Around({0.5, 1.0, 0.2}), 0);

  ExploreConfig config;
  config.scoring = "semantic";
  relevancy.Refresh(memory, memory.Similarity(std::vector<float>{0, 1}));
  const auto ground = GroundOf(RoomBefore(5));
  const double plain = FrontierWorth(ground, {19, 10, 1}, Relevancy{}, config);
  EXPECT_GE(FrontierWorth(ground, {19, 10, 1}, relevancy, config), plain);
}

}  // namespace
}  // namespace crossnav::policy
