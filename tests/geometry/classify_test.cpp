// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "tests/geometry/map_of_evidence.h"

namespace crossnav::geometry::testing {
namespace {

TEST(ClassifyTest, RandomEvidenceGivesTheStatesOfTheLiteralRule) {
  Rng rng(7);
  for (int trial = 0; trial < 40; ++trial) {
    MapConfig config;
    if (trial % 4 == 1) config.inflation_m = rng.Uniform(0, 1.0);
    if (trial % 4 == 2) config.support_depth_m = 0.1 * rng.Int(0, 12);
    if (trial % 4 == 3) config.agent_height_m = rng.Uniform(0.2, 2.6);
    std::map<VoxelKey, StairMark> surface;
    KeySet free;
    const int count = rng.Int(5, 250);
    for (int i = 0; i < count; ++i) {
      const VoxelKey key{rng.Int(-12, 12), rng.Int(-12, 12), rng.Int(-20, 20)};
      surface[key] = static_cast<StairMark>(rng.Chance(0.5) ? 0 : rng.Int(0, 3));
    }
    for (int i = 0; i < 3000; ++i)
      free.insert({rng.Int(-14, 14), rng.Int(-14, 14), rng.Int(-22, 22)});
    EXPECT_EQ(Differences(StatesOf(MapOfEvidence(surface, free, config)),
                          ClassifyLiterally(config, surface, free)),
              "")
        << "trial " << trial;
  }
}

/// A floor of 20 x 20 voxels at z = 0 with air above it.
void AddFloor(std::map<VoxelKey, StairMark>* surface, KeySet* free) {
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) {
      (*surface)[{x, y, 0}] = StairMark::kNone;
      for (int z = 1; z < 20; ++z) free->insert({x, y, z});
    }
}

TEST(InflationTest, OnlySurfacesBetweenClimbAndAgentHeightInflate) {
  for (int height = 1; height <= 18; ++height) {
    std::map<VoxelKey, StairMark> surface;
    KeySet free;
    AddFloor(&surface, &free);
    surface[{10, 10, height}] = StairMark::kNone;
    const VoxelMap map = MapOfEvidence(surface, free);
    const bool inflates = height > 3 && height <= 15;
    EXPECT_EQ(map.At({12, 10, 1}).is_inflated, inflates) << height;
    EXPECT_EQ(map.At({11, 11, 4}).is_inflated, inflates) << height;
    EXPECT_FALSE(map.At({12, 11, 1}).is_inflated) << height;  // 0.22 m away
    EXPECT_FALSE(map.At({13, 10, 1}).is_inflated) << height;
  }
}

TEST(InflationTest, AStepUpToTheClimbDoesNotInflateAndATableTopDoes) {
  std::map<VoxelKey, StairMark> surface;
  KeySet free;
  AddFloor(&surface, &free);
  for (int y = 0; y < 20; ++y) surface[{5, y, 3}] = StairMark::kNone;    // sill of 0.30 m
  for (int x = 12; x < 16; ++x) surface[{x, 10, 7}] = StairMark::kNone;  // table top
  const VoxelMap map = MapOfEvidence(surface, free);
  EXPECT_FALSE(map.At({4, 3, 1}).is_inflated);
  EXPECT_FALSE(map.At({5, 3, 4}).is_inflated);
  EXPECT_TRUE(map.At({13, 10, 1}).is_inflated);
  EXPECT_TRUE(map.At({11, 10, 1}).is_inflated);
}

TEST(InflationTest, AConfirmedFlightInflatesTheFloorBesideItButNotItself) {
  std::map<VoxelKey, StairMark> surface;
  KeySet free;
  AddFloor(&surface, &free);
  for (int step = 0; step < 6; ++step)  // steep: 0.2 m rise on 0.1 m, along y
    for (int x = 10; x < 16; ++x) {
      surface[{x, 10 + step, 2 * (step + 1)}] = StairMark::kStair;
      for (int z = 1; z <= 4; ++z) free.insert({x, 10 + step, 2 * (step + 1) + z});
    }
  VoxelMap map = MapOfEvidence(surface, free);
  EXPECT_EQ(map.StateAt({12, 11, 5}), VoxelState::kTraversableStair);
  EXPECT_FALSE(map.At({12, 11, 5}).is_inflated);
  EXPECT_FALSE(map.At({12, 11, 4}).is_inflated);  // the step itself
  EXPECT_TRUE(map.At({9, 12, 1}).is_inflated);    // the floor beside the third step
  std::vector<VoxelKey> flight;
  for (const auto& [key, mark] : surface)
    if (mark == StairMark::kStair) flight.push_back(key);
  map.MarkStair(flight, StairMark::kNone);  // unconfirmed, they are obstacles like any other
  map.UpdateStates();
  EXPECT_EQ(map.StateAt({12, 11, 5}), VoxelState::kTraversable);
  EXPECT_TRUE(map.At({12, 11, 5}).is_inflated);
}

TEST(StairMarkTest, MarksLieOnSurfacesOnlyAndStayUntilTheyAreChanged) {
  VoxelMap map = MapOfEvidence({{{0, 0, 0}, StairMark::kNone}}, {{0, 0, 1}});
  map.MarkStair({{0, 0, 0}, {0, 0, 1}, {5, 5, 5}}, StairMark::kStair);
  EXPECT_EQ(map.UpdateStates().size(), 2U);
  EXPECT_EQ(map.StateAt({0, 0, 0}), VoxelState::kStair);
  EXPECT_EQ(map.StateAt({0, 0, 1}), VoxelState::kTraversableStair);
  EXPECT_EQ(map.StairMarkAt({0, 0, 1}), StairMark::kNone);
  EXPECT_EQ(map.StairMarkAt({5, 5, 5}), StairMark::kNone);
  map.MarkStair({{0, 0, 0}}, StairMark::kStair);
  EXPECT_TRUE(map.UpdateStates().empty());
  map.MarkStair({{0, 0, 0}}, StairMark::kFake);
  map.UpdateStates();
  EXPECT_EQ(map.StateAt({0, 0, 0}), VoxelState::kFakeStair);
  EXPECT_EQ(map.StateAt({0, 0, 1}), VoxelState::kTraversable);
  map.MarkStair({{0, 0, 0}}, StairMark::kNone);
  map.UpdateStates();
  EXPECT_EQ(map.StateAt({0, 0, 0}), VoxelState::kOccupied);
}

}  // namespace
}  // namespace crossnav::geometry::testing
