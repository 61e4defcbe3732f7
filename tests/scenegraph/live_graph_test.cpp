// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/live_graph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/box_walker.h"

namespace crossnav::scenegraph {
namespace {

using crossnav::testing::BoxOf;

const memory::SemanticMemory kNothing;

/// A room of 6 x 4 m, seen from its middle in eight directions.
class SeenRoom {
 public:
  SeenRoom() {
    walker_.sensor.width_px = walker_.sensor.height_px = 96;
    walker_.rooms.shell = BoxOf(0, 0, 0, 6, 4, 2.6);
    walker_.pose.p_world = Vector3d(3, 2, 0);
  }

  /// Looks in the next direction; voxels that changed.
  std::int64_t Look() {
    walker_.pose.yaw_rad += DegToRad(45);
    const Observation obs = walker_.Look();
    (void)map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    map.ObserveBody(walker_.pose.p_world, walker_.sensor.camera_height_m);
    return static_cast<std::int64_t>(map.UpdateStates().size());
  }

  geometry::VoxelMap map;

 private:
  test::BoxWalker walker_;
};

objects::ObjectRecord Chair(double x_m, int views) {
  objects::ObjectRecord record;
  record.id = 4;
  record.category = "chair";
  record.centre_world_m = {x_m, 2, 0.4};
  record.box_world_m = {Vector3d(x_m - 0.3, 1.7, 0), Vector3d(x_m + 0.3, 2.3, 0.9)};
  record.views = views;
  record.confidence = 0.9;
  return record;
}

TEST(LiveGraph, RoomsComeAfterAWhileAndAreCutAgainOnlyWhereTheMapChanged) {
  SeenRoom room;
  LiveGraph live;
  int first = -1, step = 0;
  for (; step < 60; ++step)
    if (live.Update(room.map, kNothing, {}, {}, room.Look()) && first < 0) first = step;
  EXPECT_EQ(first, LiveGraphConfig().least_steps - 1);
  EXPECT_EQ(live.graph().rooms.size(), 1U);
  EXPECT_LE(live.cuts(), 3);
  const int cuts = live.cuts();
  for (; step < 200; ++step) EXPECT_FALSE(live.Update(room.map, kNothing, {}, {}, 0));
  EXPECT_EQ(live.cuts(), cuts);
}

TEST(LiveGraph, ObjectsFollowTheirRecords) {
  SeenRoom room;
  LiveGraph live;
  for (int i = 0; i < 30; ++i) (void)live.Update(room.map, kNothing, {}, {}, room.Look());
  const auto after = [&](const std::vector<objects::ObjectRecord>& records) {
    int changes = 0;
    for (int i = 0; i < LiveGraphConfig().object_steps; ++i)
      changes += live.Update(room.map, kNothing, {}, records, 0) ? 1 : 0;
    return changes;
  };
  EXPECT_EQ(after({Chair(2, 1)}), 0) << "one view makes no object";
  EXPECT_EQ(after({Chair(2, 2)}), 1);
  ASSERT_EQ(live.graph().objects.size(), 1U);
  EXPECT_EQ(live.graph().objects[0].room, 0);
  EXPECT_EQ(after({Chair(2, 9)}), 0);
  EXPECT_EQ(after({Chair(3, 10)}), 1);
  objects::ObjectRecord gone = Chair(3, 10);
  gone.confidence = 0.1;
  EXPECT_EQ(after({gone}), 1);
  EXPECT_TRUE(live.graph().objects.empty());
}

TEST(LiveGraph, OutlinesAreTheBordersOfTheRoomInStraightLines) {
  SceneGraph graph;
  graph.voxel_m = 0.5;
  PlanGrid<int> plan({-1, -1, 4, 4}, -1);
  // An L of three cells: (0, 0), (1, 0), (0, 1).
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1)})
    plan.cells[plan.frame.IndexOf(x, y)] = 0;
  graph.plans = {plan};
  GraphRoom room;
  room.box.min = {0, 0, 0};
  room.box.max = {1, 1, 2.5};
  const auto lines = OutlineOf(graph, room);
  EXPECT_EQ(lines.size(), 6U);
  double length_m = 0;
  for (const auto& [x0, y0, x1, y1] : lines) length_m += std::hypot(x1 - x0, y1 - y0);
  EXPECT_DOUBLE_EQ(length_m, 4);
}

}  // namespace
}  // namespace crossnav::scenegraph
