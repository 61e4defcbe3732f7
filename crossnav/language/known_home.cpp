// SPDX-License-Identifier: MIT
#include "crossnav/language/known_home.h"

#include <algorithm>
#include <set>

#include "crossnav/core/category_table.h"
#include "crossnav/objects/alias.h"
#include "crossnav/scenegraph/box_measures.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::language {
namespace {

constexpr double kLookedAt = 0.6;     // chosen: of a room's area; ground behind things stays unseen
constexpr double kBelieved = 0.3;     // as objects::BookConfig::gone
constexpr double kSamePlace_m = 0.5;  // chosen: between centres, which features blur
constexpr double kUnderGround_m = 0.5;  // as scenegraph::FloorAt

Thing ThingOf(const scenegraph::GraphObject& object) {
  Thing thing;
  thing.category = CanonicalName(object.category);
  thing.p_center_world = object.p_center_world;
  thing.box = object.box;
  thing.floor = object.floor;
  thing.room = object.room;
  thing.confidence = object.match;
  thing.is_certain = object.is_certain;
  return thing;
}

Thing ThingOf(const objects::ObjectRecord& record, const scenegraph::SceneGraph& graph) {
  Thing thing;
  thing.category = CanonicalName(record.category);
  thing.p_center_world = record.centre_world_m;
  thing.box = scenegraph::SurfaceBoxOf(record.box_world_m, graph.voxel_m);
  thing.floor = scenegraph::FloorAt(graph, record.centre_world_m);
  if (thing.floor) thing.room = scenegraph::RoomAt(graph, *thing.floor, record.centre_world_m);
  if (record.colour)
    thing.colour = SurfaceColourOf({(*record.colour)[0], (*record.colour)[1], (*record.colour)[2]});
  thing.confidence = record.confidence;
  thing.is_certain = true;
  thing.last_seen = LastSeen{record.last_seen_step, record.last_seen_day};
  return thing;
}

bool IsBelieved(const objects::ObjectRecord& record) {
  return record.confidence >= kBelieved && record.views > 0;
}

/// Whether the memory's place coincides with the record, believed or not.
bool IsOfRecord(const scenegraph::GraphObject& object, const objects::ObjectRecord& record) {
  if (CanonicalName(object.category) != CanonicalName(record.category)) return false;
  const auto& box = record.box_world_m;
  return ((object.p_center_world - record.centre_world_m).norm() <= kSamePlace_m) ||
         (!box.isEmpty() && box.contains(object.p_center_world)) ||
         ((record.centre_world_m.array() >= object.box.min.array()).all() &&
          (record.centre_world_m.array() <= object.box.max.array()).all());
}

}  // namespace

bool KnownRoom::WasLookedAt() const {
  return looked_at >= kLookedAt;
}

KnownHome HomeOf(const scenegraph::SceneGraph& graph,
                 std::span<const objects::ObjectRecord> records) {
  KnownHome home;
  for (const auto& floor : graph.floors) home.floors.push_back({floor.height_m});
  for (const auto& room : graph.rooms)
    home.rooms.push_back({room.floor, {}, room.area_m2, room.looked_at, room.p_center_world});
  for (const auto& stair : graph.stairs)
    home.may_have_more_floors |=
        !stair.lower_floor || !stair.upper_floor || stair.lower_floor == stair.upper_floor;
  std::set<std::string> asked;
  for (std::size_t i = 0; i < records.size(); ++i) {
    asked.insert(CanonicalName(records[i].category));
    if (!IsBelieved(records[i]) || objects::IsAlias(records[i], records)) continue;
    home.things.push_back(ThingOf(records[i], graph));
    home.things.back().record = static_cast<int>(i);
  }
  for (const auto& object : graph.objects) {
    const bool is_recorded = std::any_of(records.begin(), records.end(), [&](const auto& record) {
      return IsOfRecord(object, record);
    });
    if (!is_recorded) home.things.push_back(ThingOf(object));
  }
  for (const std::string& category : graph.asked) asked.insert(CanonicalName(category));
  home.asked.assign(asked.begin(), asked.end());
  TellRooms(home);
  return home;
}

void TellRooms(KnownHome& home) {
  std::vector<std::vector<std::string>> held(home.rooms.size());
  for (const Thing& thing : home.things)
    if (thing.room) held[*thing.room].push_back(thing.category);
  for (std::size_t i = 0; i < home.rooms.size(); ++i)
    home.rooms[i].fits = RoomFitsOf(held[i], home.rooms[i].WasLookedAt());
}

std::optional<int> FloorOf(const KnownHome& home, const Vector3d& p_world) {
  std::optional<int> found;
  for (std::size_t i = 0; i < home.floors.size(); ++i)
    if (home.floors[i].height_m <= p_world.z() + kUnderGround_m) found = static_cast<int>(i);
  return found;
}

}  // namespace crossnav::language
