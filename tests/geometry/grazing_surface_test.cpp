// SPDX-License-Identifier: MIT
// Which gaps between pixels are looked into, against looking into all.
#include "crossnav/geometry/grazing_surface.h"

#include <gtest/gtest.h>

#include "crossnav/geometry/frame.h"
#include "random_frames.h"

namespace crossnav::geometry {
namespace {

using testing::RandomFrame;
using testing::TestFrame;

/// Occupied voxels that a frame passed, by block.
std::vector<BlockMask> PassedOf(const MapData& map) {
  std::vector<BlockMask> passed;
  for (const GridEntry* entry : map.frame)
    passed.push_back(entry->block.hit & entry->block.frame_free & ~entry->block.frame_hit);
  return passed;
}

int CountOf(const std::vector<BlockMask>& masks) {
  int count = 0;
  for (const BlockMask& mask : masks) count += mask.Count();
  return count;
}

struct Passed {
  std::vector<BlockMask> before, after;
};

/// Voxels passed by the last frame, before and after sparing, in a map of the earlier frames.
Passed Spare(const std::vector<TestFrame>& frames, GapSearch search) {
  MapConfig config;
  config.clearing = "evidence";
  config.min_hits = 1;
  VoxelMap map(config);
  for (std::size_t i = 0; i + 1 < frames.size(); ++i)
    map.Integrate(frames[i].depth_m, frames[i].camera, frames[i].T_world_camera);
  const TestFrame& last = frames.back();
  const DepthFrame frame{last.depth_m, last.camera, last.T_world_camera};
  MapData& data = MapAccess::Of(map);
  data.view.Resize(last.depth_m.width, last.depth_m.height);
  CollectEnds(data, frame);
  CollectFreeByWalking(data, frame);
  const std::vector<BlockMask> before = PassedOf(data);
  SpareSurfacesInGaps(data, frame, search);
  return {before, PassedOf(data)};
}

TEST(Grazing, TheContestedSearchSparesTheSameVoxelsAsTheFullSearch) {
  Rng rng(7);
  int spared = 0, gone = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<TestFrame> frames(3, RandomFrame(rng, 130, 50, 1.5));
    for (TestFrame& frame : frames) {
      frame.depth_m = testing::RandomDepth(rng, 130, 50);
      frame.T_world_camera.translation() +=
          Vector3d(rng.Normal(), rng.Normal(), rng.Normal()) * 0.2;
    }
    const Passed some = Spare(frames, GapSearch::kWhereContested);
    const Passed all = Spare(frames, GapSearch::kEverywhere);
    ASSERT_EQ(some.after, all.after) << "round " << round;
    spared += CountOf(all.before) - CountOf(all.after);
    gone += CountOf(all.after);
  }
  EXPECT_GT(spared, 1000);
  EXPECT_GT(gone, 1000);
}

}  // namespace
}  // namespace crossnav::geometry
