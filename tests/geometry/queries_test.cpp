// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <thread>

#include "crossnav/core/rng.h"
#include "crossnav/geometry/map_queries.h"
#include "tests/geometry/map_of_evidence.h"

namespace crossnav::geometry::testing {
namespace {

VoxelMap RandomMap(Rng& rng, int surfaces = 300, int air = 4000) {
  std::map<VoxelKey, StairMark> surface;
  KeySet free;
  for (int i = 0; i < surfaces; ++i)
    surface[{rng.Int(-15, 15), rng.Int(-15, 15), rng.Int(-15, 15)}] =
        static_cast<StairMark>(rng.Int(0, 3));
  for (int i = 0; i < air; ++i) free.insert({rng.Int(-15, 15), rng.Int(-15, 15), rng.Int(-15, 15)});
  return MapOfEvidence(surface, free);
}

TEST(QueriesTest, CursorAtAndIterationAgree) {
  Rng rng(1);
  const VoxelMap map = RandomMap(rng);
  const std::map<VoxelKey, Voxel> states = StatesOf(map);
  VoxelMap::Cursor cursor(map);
  std::vector<VoxelKey> in_box, expected;
  for (int z = -18; z <= 18; ++z)
    for (int y = -18; y <= 18; ++y)
      for (int x = -18; x <= 18; ++x) {
        const auto it = states.find({x, y, z});
        const Voxel voxel = it == states.end() ? Voxel{} : it->second;
        ASSERT_EQ(map.At({x, y, z}), voxel);
        ASSERT_EQ(cursor.At({x, y, z}), voxel);
        if (it != states.end() && x >= -3 && y <= 9 && z > -12) expected.push_back({x, y, z});
      }
  map.ForEachInBox({-3, -99, -11}, {99, 9, 99},
                   [&](const VoxelKey& key, const Voxel&) { in_box.push_back(key); });
  EXPECT_EQ(in_box, expected);
  const MapStats stats = map.Stats();
  EXPECT_EQ(stats.known, static_cast<std::int64_t>(states.size()));
  EXPECT_GT(stats.bytes, 0);
}

TEST(QueriesTest, NearestFreeEqualsBruteForce) {
  Rng rng(2);
  const VoxelMap map = RandomMap(rng, 60);
  const std::map<VoxelKey, Voxel> states = StatesOf(map);
  for (int i = 0; i < 200; ++i) {
    const Vector3d p(rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(-2, 2));
    const double radius_m = rng.Uniform(0, 1);
    double best = radius_m;
    VoxelKey expected;
    bool is_expected = false;
    for (const auto& [key, voxel] : states) {  // in key order: the first of equals wins
      const StateFacts& facts = FactsOf(voxel.state);
      const double d = (CenterOf(key, 0.1) - p).norm();
      if (!facts.is_pathable || !facts.is_targetable || voxel.is_inflated || d > best) continue;
      if (is_expected && d == best) continue;
      best = d;
      expected = key;
      is_expected = true;
    }
    VoxelKey found;
    ASSERT_EQ(map.NearestFree(p, radius_m, &found), is_expected);
    if (is_expected) {
      ASSERT_EQ(found, expected);
    }
  }
}

TEST(QueriesTest, LineOfSightIsBlockedBySurfacesStrictlyBetween) {
  std::map<VoxelKey, StairMark> surface;
  for (int y = -5; y <= 5; ++y)
    for (int z = 0; z <= 5; ++z) surface[{10, y, z}] = StairMark::kNone;
  const VoxelMap map = MapOfEvidence(surface, {{0, 0, 0}});
  EXPECT_FALSE(map.HasLineOfSight({0.05, 0.05, 0.25}, {2.05, 0.05, 0.25}));
  EXPECT_FALSE(map.HasLineOfSight({2.05, 0.05, 0.25}, {0.05, 0.05, 0.25}));
  EXPECT_TRUE(map.HasLineOfSight({0.05, 0.05, 0.25}, {1.05, 0.05, 0.25}));  // the wall itself
  EXPECT_TRUE(map.HasLineOfSight({0.05, 0.05, 0.85}, {2.05, 0.05, 0.85}));  // over it
  EXPECT_TRUE(map.IsSeenThrough({0.05, 0.05, 0.85}, {2.05, 0.05, 0.85}, 19));
  EXPECT_FALSE(map.IsSeenThrough({0.05, 0.05, 0.85}, {2.05, 0.05, 0.85}, 18));  // unobserved
  EXPECT_FALSE(map.IsSeenThrough({0.05, 0.05, 0.25}, {2.05, 0.05, 0.25}, 19));
}

TEST(QueriesTest, ReadersMayShareAnUnwrittenMap) {
  Rng rng(6);
  const VoxelMap map = RandomMap(rng);
  const auto read = [&](std::int64_t* known) {
    VoxelMap::Cursor cursor(map);
    for (int i = 0; i < 20000; ++i) {
      const VoxelKey key{i % 31 - 15, i / 31 % 31 - 15, i / 961 % 31 - 15};
      *known += cursor.At(key).state != VoxelState::kUnknown && map.IsObserved(key);
      VoxelKey found;
      if (i % 500 == 0) map.NearestFree(CenterOf(key, 0.1), 0.5, &found);
      if (i % 50 == 0) map.HasLineOfSight(CenterOf(key, 0.1), {0, 0, 0});
    }
  };
  std::int64_t first = 0, second = 0;
  std::thread other([&] { read(&first); });
  read(&second);
  other.join();
  EXPECT_EQ(first, second);
  EXPECT_GT(first, 0);
}

TEST(QueriesTest, SupportLevelsAndColumns) {
  const VoxelMap map =
      MapOfEvidence({{{0, 0, 0}, StairMark::kNone}, {{3, 0, 27}, StairMark::kNone}},
                    {{0, 0, 1}, {0, 0, 4}, {0, 0, 5}, {3, 0, 28}});
  VoxelKey support;
  ASSERT_TRUE(map.FindSupport({0, 0, 4}, &support));
  EXPECT_EQ(support, (VoxelKey{0, 0, 0}));
  EXPECT_FALSE(map.FindSupport({0, 0, 5}, &support));
  EXPECT_DOUBLE_EQ(*StandingHeight(map, {0, 0, 1}), 0.1);
  EXPECT_FALSE(StandingHeight(map, {0, 0, 5}).has_value());
  const ExplorationLevel ground{0.05}, upper{2.8};
  EXPECT_TRUE(IsOnLevel(map, {0, 0, 4}, ground));
  EXPECT_FALSE(IsOnLevel(map, {0, 0, 4}, upper));
  EXPECT_TRUE(IsOnLevel(map, {3, 0, 28}, upper));
  EXPECT_TRUE(IsColumnObserved(map, {0, 0, 7}, 3));
  EXPECT_FALSE(IsColumnObserved(map, {0, 0, 9}, 3));
  EXPECT_FALSE(IsColumnObserved(map, {1, 0, 1}, 3));
  int neighbours = 0;
  ForEachNeighbour26(map, {0, 0, 4}, [&](const VoxelKey& key, const Voxel& voxel) {
    neighbours += voxel.state != VoxelState::kUnknown;
    EXPECT_NE(key, (VoxelKey{0, 0, 4}));
  });
  EXPECT_EQ(neighbours, 1);
}

}  // namespace
}  // namespace crossnav::geometry::testing
