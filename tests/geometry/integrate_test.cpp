// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/integrate.h"
#include "crossnav/geometry/ray_walk.h"
#include "support/places.h"
#include "tests/geometry/depth_files.h"
#include "tests/geometry/evidence_sets.h"
#include "tests/support/box_rooms.h"

namespace crossnav::geometry::testing {
namespace {

MapConfig ConfigOf(const std::string& rays) {
  MapConfig config;
  config.rays = rays;
  return config;
}

void Integrate(VoxelMap& map, const TestFrame& frame) {
  map.Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
}

FrameSets Literally(const MapConfig& config, const TestFrame& frame) {
  return IntegrateLiterally(config, frame.depth_m, frame.camera, frame.T_world_camera);
}

/// Integrates by projection whatever the size of the image.
void IntegrateByProjection(VoxelMap& map, const TestFrame& frame) {
  MapData& data = MapAccess::Of(map);
  const DepthFrame depth{frame.depth_m, frame.camera, frame.T_world_camera};
  data.view.Resize(frame.depth_m.width, frame.depth_m.height);
  CollectFreeByProjection(data, depth, CollectEnds(data, depth));
  MergeFrame(data);
}

std::vector<TestFrame> RoomFrames(int count, int side, std::uint64_t seed = 3) {
  const auto rooms = crossnav::testing::MakeBoxHouse(seed, 8, 6);
  const CameraIntrinsics camera = IntrinsicsFromHfov(side, side, DegToRad(90));
  std::vector<TestFrame> frames;
  for (const AgentPose& agent : crossnav::testing::RandomWalk(seed, rooms, count)) {
    const Pose T = CameraPose(agent, 0.88);
    frames.push_back({crossnav::testing::RenderDepth(rooms, camera, T), camera, T});
  }
  return frames;
}

TEST(IntegrateTest, ExactRaysGiveTheSetsOfTheLiteralWalk) {
  Rng rng(11);
  VoxelMap map(ConfigOf("exact"));
  ReferenceEvidence reference;
  for (int i = 0; i < 10; ++i) {
    const TestFrame frame = RandomFrame(rng);
    Integrate(map, frame);
    reference.Add(Literally(map.config(), frame));
    ASSERT_EQ(CompareEvidence(map, reference), "") << "frame " << i;
  }
}

class ProjectionSizeTest : public ::testing::TestWithParam<std::pair<int, int>> {};

TEST_P(ProjectionSizeTest, ProjectionAndWalkingFindTheSameVoxels) {
  const auto [width, height] = GetParam();
  Rng rng(width);
  VoxelMap map(ConfigOf("exact"));
  ReferenceEvidence reference;
  for (int i = 0; i < 6; ++i) {
    const TestFrame frame = RandomFrame(rng, width, height);
    IntegrateByProjection(map, frame);
    reference.Add(Literally(map.config(), frame));
    ASSERT_EQ(CompareEvidence(map, reference), "") << "frame " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Sizes, ProjectionSizeTest,
                         ::testing::Values(std::pair(1, 1), std::pair(3, 50), std::pair(37, 23),
                                           std::pair(64, 48), std::pair(131, 67)));

TEST(IntegrateTest, ExactRaysGiveTheLiteralSetsInRoomsOnVoxelFaces) {
  // Floor, walls and camera poses on whole decimetres: returns lie on voxel faces.
  VoxelMap map(ConfigOf("exact"));
  ReferenceEvidence reference;
  for (const TestFrame& frame : RoomFrames(6, 160)) {
    Integrate(map, frame);
    reference.Add(Literally(map.config(), frame));
    ASSERT_EQ(CompareEvidence(map, reference), "");
  }
}

TEST(IntegrateTest, ExactRaysGiveTheLiteralSetsForAnAxisAlignedCameraAtAVoxelCorner) {
  VoxelMap map(ConfigOf("exact"));
  TestFrame frame;
  frame.camera = IntrinsicsFromHfov(65, 65, DegToRad(90));  // the middle ray is the axis
  frame.depth_m = DepthImage(65, 65, 2.0F);
  for (int i = 0; i < 4; ++i) {
    frame.T_world_camera = CameraPose({Vector3d(0, 0, 0), i * DegToRad(90), 0}, 0.1 * i);
    ReferenceEvidence reference;
    VoxelMap fresh(ConfigOf("exact"));
    IntegrateByProjection(fresh, frame);
    reference.Add(Literally(map.config(), frame));
    EXPECT_EQ(CompareEvidence(fresh, reference), "") << i;
  }
}

TEST(IntegrateTest, FastRaysKeepTheContract) {
  VoxelMap fast(ConfigOf("fast")), exact(ConfigOf("exact"));
  for (const TestFrame& frame : RoomFrames(40, 320)) {
    Integrate(fast, frame);
    Integrate(exact, frame);
  }
  fast.UpdateStates();
  exact.UpdateStates();
  const KeySet fast_free = KeysOf(fast, &MapBlock::free);
  const KeySet exact_free = KeysOf(exact, &MapBlock::free);
  EXPECT_TRUE(KeysOf(fast, &MapBlock::hit) == KeysOf(exact, &MapBlock::hit));
  EXPECT_LT(CountMissing(exact_free, fast_free), 0.03 * static_cast<double>(exact_free.size()));
  EXPECT_LT(CountMissing(fast_free, exact_free), 0.01 * static_cast<double>(exact_free.size()));
  int traversable = 0, different = 0;
  exact.ForEach([&](const VoxelKey& key, const Voxel& voxel) {
    if (voxel.state != VoxelState::kTraversable) return;
    ++traversable;
    different += fast.At(key) == voxel ? 0 : 1;
  });
  EXPECT_LT(different, 0.01 * traversable);
}

TEST(IntegrateTest, RealDepthFramesGiveTheLiteralSets) {
  const std::vector<TestFrame> frames = ReadRgbdFrames(test::SharedPath(""), 2);
  if (frames.empty()) GTEST_SKIP() << "no shared/data/rgbd";
  VoxelMap exact(ConfigOf("exact")), fast(ConfigOf("fast"));
  ReferenceEvidence reference;
  for (const TestFrame& frame : frames) {
    Integrate(exact, frame);
    Integrate(fast, frame);
    reference.Add(Literally(exact.config(), frame));
    ASSERT_EQ(CompareEvidence(exact, reference), "");
  }
  const KeySet free = KeysOf(fast, &MapBlock::free);
  EXPECT_TRUE(KeysOf(fast, &MapBlock::hit) == reference.hit);
  EXPECT_EQ(CountMissing(free, reference.free), 0);
  EXPECT_LT(CountMissing(reference.free, free), 0.03 * static_cast<double>(reference.free.size()));
}

class RaysTest : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Rays, RaysTest, ::testing::Values("exact", "fast"));

TEST_P(RaysTest, LocalUpdatesEqualAFullRebuildAfterEveryFrame) {
  Rng rng(12);
  VoxelMap map(ConfigOf(GetParam()));
  std::map<VoxelKey, Voxel> replayed;
  for (int i = 0; i < 12; ++i) {
    Integrate(map, RandomFrame(rng));
    map.ObserveBody({rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(-1, 1)}, 0.88);
    const std::vector<StateChange>& changes = map.UpdateStates();
    for (std::size_t k = 1; k < changes.size(); ++k)
      ASSERT_LT(changes[k - 1].key, changes[k].key) << "frame " << i;
    for (const StateChange& change : changes) replayed[change.key] = change.voxel;
    const Result<VoxelMap> rebuilt = ImportBlocks(ExportBlocks(map), map.config());
    ASSERT_TRUE(rebuilt.has_value());
    ASSERT_EQ(Differences(StatesOf(map), StatesOf(*rebuilt)), "") << "frame " << i;
    ASSERT_EQ(Differences(StatesOf(map), replayed), "") << "frame " << i;
  }
}

TEST_P(RaysTest, TheOrderOfFramesDoesNotMatter) {
  std::vector<TestFrame> frames = RoomFrames(8, 96);
  VoxelMap forward(ConfigOf(GetParam())), shuffled(ConfigOf(GetParam()));
  for (const TestFrame& frame : frames) Integrate(forward, frame);
  Rng rng(5);
  rng.Shuffle(frames);
  for (const TestFrame& frame : frames) {
    Integrate(shuffled, frame);
    shuffled.UpdateStates();
  }
  forward.UpdateStates();
  EXPECT_EQ(Differences(StatesOf(forward), StatesOf(shuffled)), "");
}

TEST_P(RaysTest, TheSameFrameTwiceChangesNothing) {
  VoxelMap map(ConfigOf(GetParam()));
  for (const TestFrame& frame : RoomFrames(3, 96)) {
    Integrate(map, frame);
    map.UpdateStates();
    const std::vector<MapBlock> once = ExportBlocks(map);
    const std::uint64_t revision = map.Revision();
    Integrate(map, frame);
    EXPECT_TRUE(map.UpdateStates().empty());
    EXPECT_EQ(map.Revision(), revision);
    EXPECT_TRUE(ExportBlocks(map) == once);
  }
}

TEST_P(RaysTest, MovingTheWorldByWholeVoxelsMovesTheMap) {
  MapConfig config = ConfigOf(GetParam());
  config.voxel_m = 0.125;  // so that the move itself is exact
  for (const VoxelKey move : {VoxelKey{-1000, 300, -77}, VoxelKey{5, -3, 1}}) {
    VoxelMap here(config), there(config);
    for (TestFrame frame : RoomFrames(3, 96)) {
      Integrate(here, frame);
      frame.T_world_camera.translation() += 0.125 * Vector3d(move.x, move.y, move.z);
      Integrate(there, frame);
    }
    here.UpdateStates();
    there.UpdateStates();
    std::map<VoxelKey, Voxel> moved;
    for (const auto& [key, voxel] : StatesOf(here)) moved[key + move] = voxel;
    EXPECT_EQ(Differences(moved, StatesOf(there)), "");
  }
}

TEST_P(RaysTest, PixelsWithoutDepthSayNothing) {
  VoxelMap map(ConfigOf(GetParam()));
  TestFrame frame = RoomFrames(1, 96)[0];
  const float nothing[] = {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(), 0.05F};
  for (std::size_t i = 0; i < frame.depth_m.data.size(); ++i)
    frame.depth_m.data[i] = nothing[i % 5];
  EXPECT_TRUE(map.Integrate(frame.depth_m, frame.camera, frame.T_world_camera).empty());
  EXPECT_TRUE(map.UpdateStates().empty());
  EXPECT_EQ(map.Stats().blocks, 0);
}

TEST_P(RaysTest, RaysBeyondTheLimitAreFreeAndEndNowhere) {
  MapConfig config = ConfigOf(GetParam());
  config.depth_max_m = 1.5;
  VoxelMap map(config);
  const CameraIntrinsics camera = IntrinsicsFromHfov(96, 96, DegToRad(60));
  const Pose T = CameraPose({Vector3d(0.05, 0.05, 0), 0, 0}, 0.85);
  EXPECT_TRUE(map.Integrate(DepthImage(96, 96, 4.0F), camera, T).empty());
  map.UpdateStates();
  EXPECT_EQ(map.Stats().occupied, 0);
  EXPECT_NE(map.StateAt({14, 0, 8}), VoxelState::kUnknown);  // 1.45 m ahead
  EXPECT_EQ(map.StateAt({16, 0, 8}), VoxelState::kUnknown);
}

TEST_P(RaysTest, AClippedMapKeepsOnlyItsBox) {
  MapConfig config = ConfigOf(GetParam());
  config.clip_to_extent = true;
  config.extent_xy_m = 4;
  config.extent_z_m = 2;
  VoxelMap clipped(config), whole(ConfigOf(GetParam()));
  Rng rng(3);
  std::optional<VoxelKey> first;
  const auto is_inside = [&first](const VoxelKey& key) {
    const VoxelKey d = key - *first;
    return std::abs(d.x + 0.5) < 20 && std::abs(d.y + 0.5) < 20 && std::abs(d.z + 0.5) < 10;
  };
  for (int i = 0; i < 6; ++i) {
    const TestFrame frame = RandomFrame(rng, i < 3 ? 40 : 120, i < 3 ? 30 : 90);
    if (!first) first = KeyOf(frame.T_world_camera.translation(), config.voxel_m);
    for (const PixelVoxel& pixel :
         clipped.Integrate(frame.depth_m, frame.camera, frame.T_world_camera))
      ASSERT_TRUE(is_inside(pixel.key));
    Integrate(whole, frame);
  }
  for (const auto mask : {&MapBlock::hit, &MapBlock::free}) {
    KeySet inside;
    for (const VoxelKey& key : KeysOf(whole, mask))
      if (is_inside(key)) inside.insert(key);
    EXPECT_TRUE(KeysOf(clipped, mask) == inside);
  }
}

TEST(IntegrateTest, EndVoxelsCoverEveryValidPixelInOrder) {
  Rng rng(21);
  for (int i = 0; i < 4; ++i) {
    const TestFrame frame = RandomFrame(rng, 33 + 40 * i, 20);
    VoxelMap map;
    const EndVoxels& ends = map.Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
    std::size_t next = 0;
    for (int v = 0; v < 20; ++v)
      for (int u = 0; u < frame.camera.width_px; ++u) {
        const float z = frame.depth_m.At(u, v);
        if (!(z >= 0.1 && z <= 10)) continue;
        const Vector3d p = frame.T_world_camera * BackProjectPixel(frame.camera, u, v, z);
        ASSERT_LT(next, ends.size());
        EXPECT_EQ(ends[next].pixel, v * frame.camera.width_px + u);
        EXPECT_EQ(ends[next].key, KeyOf(p, 0.1));
        ++next;
      }
    EXPECT_EQ(next, ends.size());
  }
}

// Rows are computed in float first, which cannot tell the sides of a face, nor place voxels of 2 cm
// at a hundred metres or far from the origin.
TEST(IntegrateTest, EndVoxelsFollowTheFormulaBeyondFloatPrecision) {
  Rng rng(22);
  for (const double voxel_m : {0.02, 0.1, 0.125}) {
    for (const double farthest_m : {3.0, 10.0, 100.0}) {
      for (const double origin_m : {0.0, 1.5, 123456.7}) {
        MapConfig config;
        config.voxel_m = voxel_m;
        config.depth_max_m = farthest_m;
        TestFrame frame;
        frame.camera = IntrinsicsFromHfov(113, 5, DegToRad(90));
        frame.T_world_camera = CameraPose({Vector3d::Constant(origin_m), 0, 0}, 0.1);
        frame.depth_m = DepthImage(113, 5, static_cast<float>(0.8 * farthest_m));
        for (int v = 1; v < 5; ++v)
          for (int u = 0; u < 113; ++u)
            frame.depth_m.At(u, v) = static_cast<float>(rng.Uniform(0.05, 1.1 * farthest_m));
        VoxelMap map(config);
        const EndVoxels& ends = map.Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
        std::size_t next = 0;
        for (int pixel = 0; pixel < 5 * 113; ++pixel) {
          const int u = pixel % 113, v = pixel / 113;
          const float z = frame.depth_m.At(u, v);
          if (!(z >= config.depth_min_m && z <= farthest_m)) continue;
          const Vector3d p_vox =
              BackProjectToVoxels(frame.camera, frame.T_world_camera, u, v, z, voxel_m);
          ASSERT_LT(next, ends.size());
          EXPECT_EQ(ends[next].pixel, pixel);
          EXPECT_EQ(ends[next].key, KeyOfVoxelPoint(p_vox)) << voxel_m << " " << farthest_m;
          ++next;
        }
        EXPECT_EQ(next, ends.size());
      }
    }
  }
}

}  // namespace
}  // namespace crossnav::geometry::testing
