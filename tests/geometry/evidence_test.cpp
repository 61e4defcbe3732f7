// SPDX-License-Identifier: MIT
// map.clearing = evidence: moved objects vanish, static objects stay.
#include <gtest/gtest.h>

#include "tests/geometry/evidence_sets.h"
#include "tests/support/box_rooms.h"

namespace crossnav::geometry::testing {
namespace {

using crossnav::testing::BoxOf;
using crossnav::testing::BoxRooms;
using crossnav::testing::RenderDepth;

MapConfig EvidenceConfig(const std::string& rays = "fast") {
  MapConfig config;
  config.rays = rays;
  config.clearing = "evidence";
  return config;
}

AgentPose StandAt(double x, double y, double yaw_deg, double pitch_deg = 0) {
  return {Vector3d(x, y, 0), DegToRad(yaw_deg), DegToRad(pitch_deg)};
}

void Look(VoxelMap& map, const BoxRooms& rooms, const CameraIntrinsics& camera,
          const AgentPose& agent) {
  const Pose T = CameraPose(agent, 0.88);
  map.Integrate(RenderDepth(rooms, camera, T), camera, T);
}

class EvidenceTest : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Rays, EvidenceTest, ::testing::Values("exact", "fast"));

TEST_P(EvidenceTest, AnObjectThatMovedAwayIsGoneAfterFiveFramesThatLookThroughIt) {
  BoxRooms rooms;
  rooms.shell = BoxOf(0.03, 0.03, 0.03, 6.03, 5.03, 2.63);
  const BoxRooms empty = rooms;
  rooms.solids.push_back(BoxOf(3.02, 2.13, 0.03, 3.61, 2.74, 0.91));
  const CameraIntrinsics camera = IntrinsicsFromHfov(160, 160, DegToRad(90));
  VoxelMap map(EvidenceConfig(GetParam())), never(EvidenceConfig(GetParam()));
  const auto agent = [](int i) { return StandAt(0.8 + 0.02 * i, 2.2 + 0.03 * i, 0, -20); };
  for (int i = 0; i < 30; ++i) Look(map, rooms, camera, agent(i % 10));
  for (int i = 0; i < 30; ++i) Look(never, empty, camera, agent(i % 10));
  const KeySet before = KeysOf(map, &MapBlock::hit), background = KeysOf(never, &MapBlock::hit);
  KeySet object;
  for (const VoxelKey& key : before)
    if (background.count(key) == 0 && key.x >= 30 && key.x <= 36 && key.z > 0) object.insert(key);
  ASSERT_GT(object.size(), 50U);
  KeySet seen_through = object;  // by each of the five
  for (int i = 0; i < 5; ++i) {
    Look(map, empty, camera, agent(i));
    const Pose T = CameraPose(agent(i), 0.88);
    const FrameSets sets =
        IntegrateLiterally(map.config(), RenderDepth(empty, camera, T), camera, T);
    for (const VoxelKey& key : object)
      if (sets.free.count(key) == 0) seen_through.erase(key);
  }
  map.UpdateStates();
  EXPECT_GT(seen_through.size(), 0.9 * static_cast<double>(object.size()));
  int left = 0;
  for (const VoxelKey& key : seen_through) left += IsSurface(map.StateAt(key));
  EXPECT_EQ(left, 0) << "of " << seen_through.size();
  for (const VoxelKey& key : before)
    if (background.count(key) != 0) {
      EXPECT_TRUE(IsSurface(map.StateAt(key)));
    }
}

TEST_P(EvidenceTest, ANewObjectInLongFreeSpaceAppearsAfterTwoFramesAndVanishesAgain) {
  BoxRooms rooms;
  rooms.shell = BoxOf(0.03, 0.03, 0.03, 6.03, 5.03, 2.63);
  BoxRooms with_box = rooms;
  with_box.solids.push_back(BoxOf(3.02, 2.13, 0.03, 3.61, 2.74, 0.91));
  const CameraIntrinsics camera = IntrinsicsFromHfov(160, 160, DegToRad(90));
  VoxelMap map(EvidenceConfig(GetParam()));
  const AgentPose agent = StandAt(0.8, 2.2, 0, -20);
  const VoxelKey front = KeyOf({3.02 + 0.01, 2.4, 0.5}, 0.1);
  for (int i = 0; i < 40; ++i) Look(map, rooms, camera, agent);
  map.UpdateStates();
  EXPECT_FALSE(IsSurface(map.StateAt(front)));
  // Evidence of files is judged anew.
  auto read = ImportBlocks(ExportBlocks(map), map.config());
  ASSERT_TRUE(read) << read.error().Message();
  for (VoxelMap* each : {&map, &*read}) {
    for (int i = 0; i < 2; ++i) Look(*each, with_box, camera, agent);
    each->UpdateStates();
    EXPECT_TRUE(IsSurface(each->StateAt(front)));
    for (int i = 0; i < 5; ++i) Look(*each, rooms, camera, agent);
    each->UpdateStates();
    EXPECT_FALSE(IsSurface(each->StateAt(front)));
  }
  EXPECT_EQ(ExportBlocks(map), ExportBlocks(*read));
}

/// Share of the occupied voxels of the wall y = `wall_y` that stay.
double ShareKept(const VoxelMap& map, const KeySet& wall) {
  int kept = 0;
  for (const VoxelKey& key : wall) kept += IsSurface(map.StateAt(key));
  return static_cast<double>(kept) / static_cast<double>(wall.size());
}

TEST_P(EvidenceTest, AWallSeenAtGrazingAnglesFor200FramesKeepsItsVoxels) {
  for (const double wall_y : {0.03, 0.0999, 0.05}) {
    BoxRooms rooms;
    rooms.shell = BoxOf(-1.02, wall_y, 0.02, 9.03, 4.04, 2.63);
    const CameraIntrinsics camera = IntrinsicsFromHfov(96, 96, DegToRad(90));
    VoxelMap map(EvidenceConfig(GetParam()));
    for (int i = 0; i < 60; ++i) Look(map, rooms, camera, StandAt(0.13 * i, 2.5, -90));
    map.UpdateStates();
    KeySet wall;
    for (const VoxelKey& key : KeysOf(map, &MapBlock::hit))
      if (key.y == 0 && key.z > 0 && key.z < 25) wall.insert(key);
    ASSERT_GT(wall.size(), 1500U);
    Rng rng(4);
    for (int i = 0; i < 200; ++i) {
      const bool is_still = i % 2 == 0;  // half of the frames from one and the same place
      Look(map, rooms, camera,
           is_still
               ? StandAt(0.1, wall_y + 0.25, -2)
               : StandAt(rng.Uniform(0, 1), wall_y + rng.Uniform(0.1, 0.4), rng.Uniform(-10, 10)));
    }
    map.UpdateStates();
    EXPECT_GE(ShareKept(map, wall), 0.99) << "wall at " << wall_y << ", " << wall.size();
  }
}

TEST(EvidenceTest, AStrayReturnIsNoSurface) {
  VoxelMap map(EvidenceConfig());
  const CameraIntrinsics camera = IntrinsicsFromHfov(96, 96, DegToRad(60));
  const Pose T = CameraPose(StandAt(0.05, 0.05, 0), 0.85);
  DepthImage depth(96, 96, 3.0F);
  map.Integrate(depth, camera, T);
  DepthImage stray = depth;
  stray.At(48, 48) = 1.5F;
  map.Integrate(stray, camera, T);
  map.UpdateStates();
  EXPECT_FALSE(IsSurface(map.StateAt({15, 0, 8})));
  EXPECT_TRUE(IsSurface(map.StateAt({30, 0, 8})));
}

TEST_P(EvidenceTest, LocalUpdatesEqualAFullRebuildAfterEveryFrame) {
  Rng rng(31);
  VoxelMap map(EvidenceConfig(GetParam()));
  const auto rooms = crossnav::testing::MakeBoxHouse(3, 5, 4);
  const CameraIntrinsics camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
  for (int i = 0; i < 25; ++i) {
    BoxRooms moved = rooms;
    moved.solids[rng.Below(static_cast<std::uint32_t>(moved.solids.size()))].max.z() = 0.1;
    Look(map, moved, camera, crossnav::testing::RandomStand(rng, rooms, 0));
    map.UpdateStates();
    const Result<VoxelMap> rebuilt = ImportBlocks(ExportBlocks(map), map.config());
    ASSERT_TRUE(rebuilt.has_value());
    ASSERT_EQ(Differences(StatesOf(map), StatesOf(*rebuilt)), "") << "frame " << i;
  }
}

}  // namespace
}  // namespace crossnav::geometry::testing
