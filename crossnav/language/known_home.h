// SPDX-License-Identifier: MIT
// Known home: floors, rooms with their possible types, and things, for descriptions and questions.
// Built from a map's graph and its records of objects; tests build it by hand. World frame, metres.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/image.h"
#include "crossnav/language/room_type.h"
#include "crossnav/objects/object_record.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::language {

/// Time of the last sighting.
struct LastSeen {
  std::int64_t step = 0;  ///< of the day's run
  int day = 0;            ///< runs with this memory before it
};

struct Thing {
  std::string category;  ///< canonical name
  Vector3d p_center_world = Vector3d::Zero();
  Box3 box;
  std::optional<int> floor, room;
  std::optional<Rgb8> colour;  ///< mean of its surface; empty = never seen in colour
  double confidence = 0;       ///< of presence [0, 1]; for a place in the memory, its match
  bool is_certain = false;     ///< the confidence is above a calibrated threshold
  std::optional<LastSeen> last_seen;
  int record = -1;  ///< index into the records; -1 = a place in the memory
};

struct KnownFloor {
  double height_m = 0;
};

struct KnownRoom {
  int floor = 0;
  RoomFits fits{};
  double area_m2 = 0;
  double looked_at = 0;  ///< share of its area [0, 1]
  Vector3d p_center_world = Vector3d::Zero();
  bool WasLookedAt() const;
};

struct KnownHome {
  std::vector<KnownFloor> floors;  ///< lowest first
  std::vector<KnownRoom> rooms;
  std::vector<Thing> things;
  std::vector<std::string> asked;  ///< queried categories, found or not
  /// Stairs lead to unvisited ground: floors may be missing below, above and between.
  bool may_have_more_floors = false;
  int ground_floor = 0;                   ///< index; floors below it are basements
  std::optional<Vector3d> p_robot_world;  ///< foot point; empty = no robot
};

/// Believed records, and objects of the graph without a record.
KnownHome HomeOf(const scenegraph::SceneGraph& graph,
                 std::span<const objects::ObjectRecord> records = {});

/// Sets the types of rooms from the things in them. HomeOf calls it.
void TellRooms(KnownHome& home);

/// Floor that a point belongs to: the highest at most half a metre above it.
std::optional<int> FloorOf(const KnownHome& home, const Vector3d& p_world);

}  // namespace crossnav::language
