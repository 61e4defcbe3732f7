// SPDX-License-Identifier: MIT
#include "crossnav/geometry/sparse_grid.h"

#include <gtest/gtest.h>

#include <set>

#include "crossnav/core/rng.h"
#include "crossnav/geometry/block_mask.h"

namespace crossnav::geometry {
namespace {

TEST(SparseGridTest, KeysAndCellsConvertBothWaysForAnySign) {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const VoxelKey key{rng.Int(-100000, 100000), rng.Int(-50, 50), rng.Int(-9, 9)};
    EXPECT_EQ(KeyInBlock(BlockKeyOf(key), CellIndexOf(key)), key);
  }
  EXPECT_EQ(BlockKeyOf({-1, -8, -9}), (VoxelKey{-1, -1, -2}));
}

TEST(SparseGridTest, BlocksStayWhereTheyAreAndKeepTheirOrder) {
  SparseGrid<int> grid;
  Rng rng(2);
  std::vector<std::pair<VoxelKey, int*>> made;
  std::set<VoxelKey> seen;
  for (int i = 0; i < 3000; ++i) {
    const VoxelKey key{rng.Int(-9, 9), rng.Int(-9, 9), rng.Int(-9, 9)};
    int& block = grid.Touch(key);
    if (!seen.insert(key).second) continue;
    block = i;
    made.emplace_back(key, &block);
  }
  ASSERT_EQ(grid.size(), made.size());
  std::size_t next = 0;
  for (const auto& entry : grid.entries()) {
    EXPECT_EQ(entry.key, made[next].first);
    EXPECT_EQ(&entry.block, made[next++].second);
  }
  for (const auto& [key, block] : made) EXPECT_EQ(grid.Find(key), block);
  EXPECT_EQ(grid.Find({10, 0, 0}), nullptr);
}

TEST(SparseGridTest, ACursorSeesBlocksMadeAfterItLooked) {
  SparseGrid<int> grid;
  GridCursor<int> cursor(grid);
  EXPECT_EQ(cursor.Find({1, 2, 3}), nullptr);
  cursor.Touch({1, 2, 3}) = 7;
  EXPECT_EQ(*cursor.Find({7, 7, 7}), 7);
  EXPECT_EQ(*grid.Find({0, 0, 0}), 7);
}

TEST(SparseGridTest, KnownBlocksEqualTheGridsDespiteHashCollisions) {
  SparseGrid<int> grid;
  KnownBlocks<int> known;
  Rng rng(4);
  int asked = 0;
  const auto find = [&](const VoxelKey& block_key) -> int& {
    ++asked;
    return grid.Touch(block_key);
  };
  const auto cell = [&rng] { return static_cast<int>(rng.Uniform(-40, 40)); };
  for (int i = 0; i < 20000; ++i) {
    const VoxelKey key{cell(), cell(), cell()};
    EXPECT_EQ(&known.Of(key, find), &grid.Touch(BlockKeyOf(key)));
    const int once = asked;
    known.Of(key, find);
    EXPECT_EQ(asked, once);
  }
  EXPECT_GT(grid.size(), 900U);
  constexpr int kFar = 256 * kBlockSide;  // along one axis, at the same place
  for (const VoxelKey& key : {VoxelKey{}, {kFar, 0, 0}, {}, {0, kFar, 0}, {}, {0, 0, kFar}})
    EXPECT_EQ(&known.Of(key, find), &grid.Touch(BlockKeyOf(key)));
}

TEST(BlockMaskTest, VisitsItsCellsInOrder) {
  BlockMask mask;
  std::set<int> cells = {0, 1, 63, 64, 200, 511};
  for (const int cell : cells) mask.Set(cell);
  std::vector<int> visited;
  ForEachCell(mask, [&](int cell) { visited.push_back(cell); });
  EXPECT_EQ(visited, std::vector<int>(cells.begin(), cells.end()));
  EXPECT_EQ(mask.Count(), 6);
  mask.Reset(64);
  EXPECT_FALSE(mask.Test(64));
  EXPECT_FALSE((mask & ~mask).Any());
}

}  // namespace
}  // namespace crossnav::geometry
