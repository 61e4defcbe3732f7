// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/build_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "crossnav/core/cells.h"
#include "crossnav/objects/alias.h"
#include "crossnav/scenegraph/box_measures.h"
#include "crossnav/scenegraph/cut_rooms.h"

namespace crossnav::scenegraph {
namespace {

constexpr double kUnderGround_m = 0.5;     // chosen: the ground of a sunken room
constexpr double kRoomReach_m = 0.5;       // chosen: wall-hung objects belong to the room
constexpr double kTile_m = 0.5;            // chosen: squares of GraphRoom::looked_at
constexpr double kDefaultCeiling_m = 2.5;  // chosen: where no ceiling was seen

/// Squares with at least one feature row between the floor and the ceiling.
using Tiles = std::set<std::pair<int, int>>;

Tiles LookedAt(const memory::SemanticMemory& memory, const Box3& slab, int tile) {
  Tiles tiles;
  for (const auto& key : memory.Keys()) {
    const double z_m = (key.z + 0.5) * memory.VoxelSize();
    if (z_m >= slab.min.z() && z_m <= slab.max.z())
      tiles.emplace(key.x >= 0 ? key.x / tile : (key.x + 1) / tile - 1,
                    key.y >= 0 ? key.y / tile : (key.y + 1) / tile - 1);
  }
  return tiles;
}

struct RoomCells {
  int count = 0;
  float widest = -1;
  std::size_t center = 0;
  Tiles tiles;
};

/// Cells of the rooms of a plan, by number on the floor.
std::vector<RoomCells> CellsOf(const PlanGrid<int>& plan, const PlanGrid<float>& distance,
                               int tile) {
  std::vector<RoomCells> rooms;
  for (std::size_t i = 0; i < plan.cells.size(); ++i) {
    const int room = plan.cells[i];
    if (room == kNoRoom) continue;
    if (rooms.size() <= static_cast<std::size_t>(room)) rooms.resize(room + 1);
    RoomCells& cells = rooms[room];
    ++cells.count;
    const int x = plan.frame.XOf(i), y = plan.frame.YOf(i);
    cells.tiles.emplace(x >= 0 ? x / tile : (x + 1) / tile - 1,
                        y >= 0 ? y / tile : (y + 1) / tile - 1);
    if (distance.cells[i] <= cells.widest) continue;
    cells.widest = distance.cells[i];
    cells.center = i;
  }
  return rooms;
}

double ShareOf(const Tiles& tiles, const Tiles& looked_at) {
  std::size_t shared = 0;
  for (const auto& tile : tiles) shared += looked_at.count(tile);
  return tiles.empty() ? 0 : static_cast<double>(shared) / static_cast<double>(tiles.size());
}

/// Appends the rooms of one floor; replaces the numbers in `plan`, from 0, by room ids.
void AddRooms(SceneGraph& graph, const GraphFloor& floor, PlanGrid<int> plan,
              const PlanGrid<float>& distance, const memory::SemanticMemory& memory) {
  const double voxel_m = graph.voxel_m;
  const int tile = std::max(1, CellsNearest(kTile_m, voxel_m));
  const int first = static_cast<int>(graph.rooms.size());
  const double top_m = floor.ceiling_m.value_or(floor.height_m + kDefaultCeiling_m);
  Box3 slab;
  slab.min.z() = floor.height_m - kUnderGround_m;
  slab.max.z() = top_m;
  const Tiles looked_at = LookedAt(memory, slab, tile);
  for (const RoomCells& cells : CellsOf(plan, distance, tile)) {
    GraphRoom room;
    room.id = static_cast<int>(graph.rooms.size());
    room.floor = floor.id;
    room.area_m2 = cells.count * voxel_m * voxel_m;
    room.p_center_world = {(plan.frame.XOf(cells.center) + 0.5) * voxel_m,
                           (plan.frame.YOf(cells.center) + 0.5) * voxel_m, floor.height_m};
    room.looked_at = ShareOf(cells.tiles, looked_at);
    graph.rooms.push_back(room);
  }
  for (std::size_t i = 0; i < plan.cells.size(); ++i) {
    if (plan.cells[i] == kNoRoom) continue;
    plan.cells[i] += first;
    const double x_m = plan.frame.XOf(i) * voxel_m, y_m = plan.frame.YOf(i) * voxel_m;
    Box3& box = graph.rooms[plan.cells[i]].box;
    box.Add({x_m, y_m, floor.height_m});
    box.Add({x_m + voxel_m, y_m + voxel_m, top_m});
  }
  graph.plans.push_back(std::move(plan));
}

/// Passages where cells of two rooms are adjacent: one for each pair of rooms.
void AddPassages(SceneGraph& graph, const GraphFloor& floor) {
  struct Border {
    Vector3d sum = Vector3d::Zero();
    int sides = 0;
  };
  std::map<std::pair<int, int>, Border> borders;
  const PlanGrid<int>& plan = graph.plans[floor.id];
  for (std::size_t i = 0; i < plan.cells.size(); ++i) {
    ForEachBeside(plan.frame, i, kSides, [&](std::size_t beside) {
      const int a = plan.cells[i], b = plan.cells[beside];
      if (a == kNoRoom || b == kNoRoom || a >= b) return;
      Border& border = borders[{a, b}];
      border.sum += 0.5 * Vector3d(plan.frame.XOf(i) + plan.frame.XOf(beside) + 1,
                                   plan.frame.YOf(i) + plan.frame.YOf(beside) + 1, 0);
      ++border.sides;
    });
  }
  for (const auto& [pair, border] : borders) {
    GraphPassage passage{pair.first, pair.second, border.sum / border.sides * graph.voxel_m,
                         border.sides * graph.voxel_m};
    passage.p_world.z() = floor.height_m;
    graph.passages.push_back(passage);
  }
}

}  // namespace

std::string_view NameOf(RelationKind kind) {
  constexpr std::string_view kNames[] = {"on", "in", "next to", "near", "above"};
  return kNames[static_cast<int>(kind)];
}

SceneGraph BuildGraph(const geometry::VoxelMap& map, const memory::SemanticMemory& memory,
                      const std::vector<geometry::StairFlight>& flights) {
  SceneGraph graph;
  graph.voxel_m = map.config().voxel_m;
  for (const Storey& storey : FindStoreys(map)) {
    const GraphFloor floor{static_cast<int>(graph.floors.size()), storey.height_m, storey.area_m2,
                           storey.ceiling_m};
    graph.floors.push_back(floor);
    const auto cells = FloorCellsOf(map, storey);
    AddRooms(graph, floor, CutRooms(cells, graph.voxel_m), WallDistance(cells), memory);
    AddPassages(graph, floor);
  }
  for (const geometry::StairFlight& flight : flights)
    graph.stairs.push_back(
        {flight.id, FloorAt(graph, flight.p_foot_world), FloorAt(graph, flight.p_top_world)});
  return graph;
}

std::optional<int> FloorAt(const SceneGraph& graph, const Vector3d& p_world) {
  std::optional<int> found;
  for (const GraphFloor& floor : graph.floors)
    if (floor.height_m <= p_world.z() + kUnderGround_m) found = floor.id;
  return found;
}

std::optional<int> RoomAt(const SceneGraph& graph, int floor, const Vector3d& p_world) {
  const PlanGrid<int>& plan = graph.plans[floor];
  const int x = static_cast<int>(std::floor(p_world.x() / graph.voxel_m));
  const int y = static_cast<int>(std::floor(p_world.y() / graph.voxel_m));
  const int reach = CellsFloor(kRoomReach_m, graph.voxel_m);
  std::optional<int> nearest;
  int least = reach * reach + 1;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const int room = plan.At(x + dx, y + dy, kNoRoom);
      if (room == kNoRoom || dx * dx + dy * dy >= least) continue;
      least = dx * dx + dy * dy;
      nearest = room;
    }
  return nearest;
}

void LocateRecords(const SceneGraph& graph, std::vector<objects::ObjectRecord>& records) {
  for (objects::ObjectRecord& record : records) {
    record.floor = FloorAt(graph, record.centre_world_m).value_or(-1);
    record.room =
        record.floor < 0 ? -1 : RoomAt(graph, record.floor, record.centre_world_m).value_or(-1);
  }
}

void AddRecords(SceneGraph& graph, std::span<const objects::ObjectRecord> records, double least,
                int least_views) {
  for (const objects::ObjectRecord& record : records) {
    if (record.confidence < least || record.views < least_views ||
        objects::IsAlias(record, records))
      continue;
    GraphObject object;
    object.category = record.category;
    object.p_center_world = record.centre_world_m;
    object.box = SurfaceBoxOf(record.box_world_m, graph.voxel_m);
    object.match = 1;
    object.is_certain = true;
    object.record = record.id;
    object.confidence = record.confidence;
    AddObject(graph, std::move(object));
  }
}

void AddObject(SceneGraph& graph, GraphObject object) {
  object.id = static_cast<int>(graph.objects.size());
  object.floor = FloorAt(graph, object.p_center_world);
  if (object.floor) object.room = RoomAt(graph, *object.floor, object.p_center_world);
  graph.objects.push_back(std::move(object));
}

}  // namespace crossnav::scenegraph
