// SPDX-License-Identifier: MIT
// Scene graph of a map: building, floors, rooms, objects and their relations. Plain data;
// build_graph.h makes it, `crossnav map graph` writes it. World frame, metres.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/scenegraph/plan_grid.h"

namespace crossnav::scenegraph {

struct GraphFloor {
  int id = 0;  ///< from 0, the lowest seen floor
  double height_m = 0;
  double area_m2 = 0;               ///< of the seen ground
  std::optional<double> ceiling_m;  ///< height in the world; empty = not seen
};

struct GraphRoom {
  int id = 0;     ///< in the whole building, from 0, floor by floor
  int floor = 0;  ///< id
  double area_m2 = 0;
  Vector3d p_center_world = Vector3d::Zero();  ///< a point of the room, far from its walls
  Box3 box;                                    ///< ground to ceiling
  /// Share of the room's area, in squares of half a metre, with features in the memory: looked at,
  /// not only measured [0, 1].
  double looked_at = 0;
};

struct GraphObject {
  int id = 0;
  std::string category;
  Vector3d p_center_world = Vector3d::Zero();
  Box3 box;
  std::optional<int> floor, room;    ///< ids; empty = no floor or room found
  double match = 0;                  ///< 0 chance, 1 the name itself (memory/query_match.h)
  bool is_certain = false;           ///< the match is above the calibrated threshold of presence
  int record = -1;                   ///< id of the object's record; -1 = from features only
  std::optional<double> confidence;  ///< of the record: that the object is still there [0, 1]
};

/// Two rooms that meet: a door, an archway.
struct GraphPassage {
  int room_a = 0, room_b = 0;  ///< ids, a < b
  Vector3d p_world = Vector3d::Zero();
  double width_m = 0;
};

/// A stair between floors.
struct GraphStair {
  int flight = 0;  ///< StairFlight::id
  std::optional<int> lower_floor, upper_floor;
};

enum class RelationKind { kOn, kIn, kNextTo, kNear, kAbove };
std::string_view NameOf(RelationKind kind);

/// "object `from` is on object `to`". "Next to" and "near" are symmetric and listed once.
struct GraphRelation {
  RelationKind kind = RelationKind::kNear;
  int from = 0, to = 0;  ///< object ids
  friend bool operator==(const GraphRelation&, const GraphRelation&) = default;
};

struct SceneGraph {
  double voxel_m = 0;
  std::vector<GraphFloor> floors;
  std::vector<GraphRoom> rooms;
  std::vector<GraphPassage> passages;
  std::vector<GraphStair> stairs;
  std::vector<std::string> asked;  ///< queried categories, found or not
  std::vector<GraphObject> objects;
  std::vector<GraphRelation> relations;
  /// For each floor: room of each column, -1 = none. Not written to files.
  std::vector<PlanGrid<int>> plans;
};

}  // namespace crossnav::scenegraph
