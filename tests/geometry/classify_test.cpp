// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "crossnav/geometry/map_blocks.h"
#include "tests/geometry/random_frames.h"
#include "tests/geometry/reference_map.h"

namespace crossnav::geometry::testing {
namespace {

/// A map whose evidence is `surface` and `free`.
VoxelMap MapOf(const std::map<VoxelKey, StairMark>& surface, const KeySet& free,
               const MapConfig& config = {}) {
  SparseGrid<MapBlock> grid;
  for (const auto& [key, mark] : surface) {
    MapBlock& block = grid.Touch(BlockKeyOf(key));
    block.hit.Set(CellIndexOf(key));
    if (static_cast<int>(mark) & 1) block.stair_low.Set(CellIndexOf(key));
    if (static_cast<int>(mark) & 2) block.stair_high.Set(CellIndexOf(key));
  }
  for (const VoxelKey& key : free)
    if (surface.count(key) == 0) grid.Touch(BlockKeyOf(key)).free.Set(CellIndexOf(key));
  std::vector<MapBlock> blocks;
  for (auto& entry : grid.entries()) {
    entry.block.key = entry.key;
    blocks.push_back(entry.block);
  }
  return std::move(*ImportBlocks(blocks, config));
}

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
    EXPECT_EQ(Differences(StatesOf(MapOf(surface, free, config)),
                          ClassifyLiterally(config, surface, free)),
              "")
        << "trial " << trial;
  }
}

}  // namespace
}  // namespace crossnav::geometry::testing
