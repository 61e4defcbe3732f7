// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "crossnav/geometry/map_blocks.h"
#include "tests/geometry/random_frames.h"
#include "tests/geometry/reference_map.h"

namespace crossnav::geometry::testing {
namespace {

KeySet KeysOf(const VoxelMap& map, BlockMask MapBlock::*mask) {
  KeySet keys;
  for (const MapBlock& block : ExportBlocks(map))
    ForEachCell(block.*mask, [&](int cell) { keys.insert(KeyInBlock(block.key, cell)); });
  return keys;
}

TEST(IntegrateTest, ExactRaysGiveTheSetsOfTheLiteralWalk) {
  Rng rng(11);
  MapConfig config;
  config.rays = "exact";
  VoxelMap map(config);
  ReferenceEvidence reference;
  for (int i = 0; i < 12; ++i) {
    const TestFrame frame = RandomFrame(rng);
    map.Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
    reference.Add(IntegrateLiterally(config, frame.depth_m, frame.camera, frame.T_world_camera));
    ASSERT_TRUE(KeysOf(map, &MapBlock::hit) == reference.hit) << "frame " << i;
    ASSERT_TRUE(KeysOf(map, &MapBlock::free) == reference.free) << "frame " << i;
  }
}

TEST(IntegrateTest, LocalUpdatesEqualAFullRebuildAfterEveryFrame) {
  Rng rng(12);
  VoxelMap map;
  for (int i = 0; i < 12; ++i) {
    const TestFrame frame = RandomFrame(rng);
    map.Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
    map.UpdateStates();
    const Result<VoxelMap> rebuilt = ImportBlocks(ExportBlocks(map), map.config());
    ASSERT_TRUE(rebuilt.has_value());
    ASSERT_EQ(Differences(StatesOf(map), StatesOf(*rebuilt)), "") << "frame " << i;
  }
}

}  // namespace
}  // namespace crossnav::geometry::testing
