// SPDX-License-Identifier: MIT
// Which gaps between pixels are looked into, against looking into all.
#include "crossnav/geometry/grazing.h"

#include <gtest/gtest.h>

#include "crossnav/geometry/frame.h"
#include "random_frames.h"

namespace crossnav::geometry {
namespace {

using testing::RandomFrame;
using testing::TestFrame;

struct Spared {
  std::vector<BlockMask> passed;  ///< occupied voxels that count as passed, by block
  int passed_before = 0, passed_after = 0;
};

int CountPassed(const MapData& map) {
  int count = 0;
  for (const GridEntry* entry : map.frame)
    count += (entry->block.hit & entry->block.frame_free).Count();
  return count;
}

/// What `search` leaves of a frame's passes, in a map that has seen the frames before it.
Spared Spare(const std::vector<TestFrame>& frames, GapSearch search) {
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
  Spared spared;
  spared.passed_before = CountPassed(data);
  SpareSurfacesInGaps(data, frame, search);
  spared.passed_after = CountPassed(data);
  for (const GridEntry* entry : data.frame)
    spared.passed.push_back(entry->block.hit & entry->block.frame_free & ~entry->block.frame_hit);
  return spared;
}

TEST(Grazing, LookingWhereVoxelsAreContestedSparesWhatLookingEverywhereDoes) {
  Rng rng(7);
  int spared = 0, gone = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<TestFrame> frames(3, RandomFrame(rng, 130, 50, 1.5));
    for (TestFrame& frame : frames) {
      frame.depth_m = testing::RandomDepth(rng, 130, 50);
      frame.T_world_camera.translation() +=
          Vector3d(rng.Normal(), rng.Normal(), rng.Normal()) * 0.2;
    }
    const Spared some = Spare(frames, GapSearch::kWhereContested);
    const Spared all = Spare(frames, GapSearch::kEverywhere);
    ASSERT_EQ(some.passed, all.passed) << "round " << round;
    spared += all.passed_before - all.passed_after;
    gone += all.passed_after;
  }
  EXPECT_GT(spared, 1000);
  EXPECT_GT(gone, 1000);
}

}  // namespace
}  // namespace crossnav::geometry
