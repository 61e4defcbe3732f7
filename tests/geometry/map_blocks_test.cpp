// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/geometry/map_of_evidence.h"
#include "tests/geometry/random_frames.h"

namespace crossnav::geometry::testing {
namespace {

class MapBlocksTest : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Clearing, MapBlocksTest, ::testing::Values("never", "evidence"));

TEST_P(MapBlocksTest, ARestoredMapIsEqualAndStaysEqual) {
  MapConfig config;
  config.clearing = GetParam();
  VoxelMap map(config);
  Rng rng(8);
  for (int i = 0; i < 6; ++i) {
    const TestFrame frame = RandomFrame(rng);
    map.Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
    map.ObserveBody({0.1 * i, 0, 0}, 0.88);
  }
  map.UpdateStates();
  std::vector<VoxelKey> surfaces;
  map.ForEach([&](const VoxelKey& key, const Voxel& voxel) {
    if (IsSurface(voxel.state)) surfaces.push_back(key);
  });
  surfaces.resize(surfaces.size() / 2);
  map.MarkStair(surfaces, StairMark::kExpanded);
  map.UpdateStates();

  Result<VoxelMap> restored = ImportBlocks(ExportBlocks(map), config);
  ASSERT_TRUE(restored.has_value());
  EXPECT_TRUE(ExportBlocks(*restored) == ExportBlocks(map));
  EXPECT_EQ(Differences(StatesOf(map), StatesOf(*restored)), "");
  for (int i = 0; i < 3; ++i) {
    const TestFrame frame = RandomFrame(rng);
    for (VoxelMap* m : {&map, &*restored})
      m->Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
  }
  map.UpdateStates();
  restored->UpdateStates();
  EXPECT_TRUE(ExportBlocks(*restored) == ExportBlocks(map));
}

// Evidence from a map without counts, and old evidence, yields to two new frames.
TEST(MapBlocksTest, EvidenceOfAnOldMapGivesWayToTwoFrames) {
  MapConfig config;
  config.clearing = "evidence";
  for (const bool was_counted : {false, true}) {
    MapBlock block;
    block.hit.Set(5);
    block.free.Set(6);
    if (was_counted) {
      block.counts.resize(kBlockVoxels);
      block.counts[5] = {static_cast<std::uint16_t>(config.max_hits), 0};
    }
    CountAsOld(config, &block);
    EXPECT_TRUE(ImportBlocks({block}, config).has_value());
    EXPECT_EQ(block.counts[5].hits, config.min_hits + 1);
    EXPECT_EQ(block.counts[5].passes, 0);
    EXPECT_EQ(block.counts[6].passes, was_counted ? 0 : config.max_hits);
  }
}

TEST(MapBlocksTest, BadBlocksAreNamed) {
  MapBlock block;
  block.key = {1, -2, 3};
  block.hit.Set(5);
  EXPECT_TRUE(ImportBlocks({block}, {}).has_value());
  EXPECT_EQ(ImportBlocks({block, block}, {}).error().where, "block 1,-2,3");
  MapBlock both = block;
  both.free.Set(5);
  EXPECT_FALSE(ImportBlocks({both}, {}).has_value());
  MapBlock counted = block;
  counted.counts.resize(7);
  EXPECT_FALSE(ImportBlocks({counted}, {}).has_value());
}

}  // namespace
}  // namespace crossnav::geometry::testing
