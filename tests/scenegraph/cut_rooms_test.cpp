// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "crossnav/scenegraph/box_measures.h"
#include "crossnav/scenegraph/build_graph.h"
#include "crossnav/scenegraph/cut_rooms.h"

namespace crossnav::scenegraph {
namespace {

/// '.' open, 'd' lintel, '#' wall, ' ' outside; each letter is 3 x 3 cells of 0.1 m.
PlanGrid<FloorCell> Drawn(const std::vector<std::string>& rows) {
  constexpr int kScale = 3;
  PlanGrid<FloorCell> plan(
      {0, 0, kScale * static_cast<int>(rows[0].size()), kScale * static_cast<int>(rows.size())},
      FloorCell::kOutside);
  for (std::size_t i = 0; i < plan.cells.size(); ++i) {
    const char c = rows[plan.frame.YOf(i) / kScale][plan.frame.XOf(i) / kScale];
    if (c == '.') plan.cells[i] = FloorCell::kOpen;
    if (c == 'd') plan.cells[i] = FloorCell::kLintel;
    if (c == '#') plan.cells[i] = FloorCell::kWall;
  }
  return plan;
}

int RoomOf(const PlanGrid<int>& rooms, int column, int row) {
  return rooms.At(3 * column + 1, 3 * row + 1, kNoRoom);
}

int CountOf(const PlanGrid<int>& rooms) {
  std::set<int> ids(rooms.cells.begin(), rooms.cells.end());
  ids.erase(kNoRoom);
  return static_cast<int>(ids.size());
}

// Two rooms above a corridor: the left one behind a door, the right one behind an open archway.
const std::vector<std::string> kPlan = [] {
  const std::string wall(23, '#');
  std::vector<std::string> rows(21, "#.....................#");
  for (int row = 1; row <= 10; ++row) rows[row][11] = '#';
  rows.front() = rows.back() = wall;
  rows[11] = "#####ddd######...######";
  return rows;
}();

TEST(CutRooms, DoorsAndArchwaysPartRoomsFromACorridor) {
  const auto rooms = CutRooms(Drawn(kPlan), 0.1);
  EXPECT_EQ(CountOf(rooms), 3);
  const int left = RoomOf(rooms, 3, 3), right = RoomOf(rooms, 17, 3), hall = RoomOf(rooms, 10, 15);
  EXPECT_NE(left, kNoRoom);
  EXPECT_NE(left, right);
  EXPECT_NE(left, hall);
  EXPECT_NE(right, hall);
  EXPECT_EQ(RoomOf(rooms, 1, 1), left);
  EXPECT_EQ(RoomOf(rooms, 21, 10), right);
  EXPECT_EQ(RoomOf(rooms, 1, 19), hall);
  EXPECT_NE(RoomOf(rooms, 6, 11), kNoRoom) << "a doorway belongs to a room";
}

TEST(CutRooms, AWideOpeningJoins) {
  auto plan = kPlan;
  plan[11] = "#####ddd#####......####";
  const auto rooms = CutRooms(Drawn(plan), 0.1);
  EXPECT_EQ(CountOf(rooms), 2);
  EXPECT_EQ(RoomOf(rooms, 17, 3), RoomOf(rooms, 10, 15));
}

TEST(CutRooms, ACupboardIsNoRoomAndNothingIsNone) {
  EXPECT_EQ(CountOf(CutRooms(Drawn({"#####", "#..##", "#####"}), 0.1)), 0);
  EXPECT_EQ(CountOf(CutRooms(Drawn({"   ", "   "}), 0.1)), 0);
  EXPECT_TRUE(CutRooms({}, 0.1).cells.empty());
}

TEST(BuildGraph, AnEmptyMapHasNoFloors) {
  const auto graph = BuildGraph(geometry::VoxelMap(), memory::SemanticMemory(), {});
  EXPECT_TRUE(graph.floors.empty());
  EXPECT_TRUE(graph.rooms.empty());
}

GraphObject BoxOf(const Vector3d& min, const Vector3d& max, std::optional<int> room = 0) {
  GraphObject object;
  object.box.min = min, object.box.max = max;
  object.floor = 0, object.room = room;
  return object;
}

std::vector<GraphRelation> Between(GraphObject a, GraphObject b) {
  SceneGraph graph;
  a.id = 0, b.id = 1;
  graph.objects = {a, b};
  RelateObjects(graph);
  return graph.relations;
}

TEST(Relations, FollowFromTheBoxes) {
  const auto table = BoxOf({0, 0, 0}, {1, 1, 0.7});
  using R = std::vector<GraphRelation>;
  EXPECT_EQ(Between(table, BoxOf({.2, .2, .7}, {.4, .4, 1})), (R{{RelationKind::kOn, 1, 0}}));
  EXPECT_EQ(Between(table, BoxOf({.2, .2, 1.5}, {.4, .4, 2})), (R{{RelationKind::kAbove, 1, 0}}));
  EXPECT_EQ(Between(table, BoxOf({.2, .2, .2}, {.4, .4, .5})), (R{{RelationKind::kIn, 1, 0}}));
  EXPECT_EQ(Between(table, BoxOf({1.2, 0, 0}, {2, 1, 1})), (R{{RelationKind::kNextTo, 0, 1}}));
  EXPECT_EQ(Between(table, BoxOf({2, 0, 0}, {3, 1, 1})), (R{{RelationKind::kNear, 0, 1}}));
  EXPECT_EQ(Between(table, BoxOf({4, 0, 0}, {5, 1, 1})), R{});
  EXPECT_EQ(Between(table, BoxOf({1.2, 0, 0}, {2, 1, 1}, 1)), R{}) << "a wall lies between";
}

TEST(Relations, ABoxOfVoxelsIsHalfAVoxelTooLargeOnEachSide) {
  const Eigen::AlignedBox3d voxels(Vector3d(0, 0, 0), Vector3d(1, 0.1, 0.5));
  const Box3 box = SurfaceBoxOf(voxels, 0.1);
  EXPECT_TRUE(box.min.isApprox(Vector3d(0.05, 0.04, 0.05))) << "a picture keeps some depth";
  EXPECT_TRUE(box.max.isApprox(Vector3d(0.95, 0.06, 0.45)));
}

}  // namespace
}  // namespace crossnav::scenegraph
