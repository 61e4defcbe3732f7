// SPDX-License-Identifier: MIT
#include "crossnav/agent/search_shares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/agent/carriers.h"
#include "crossnav/agent/whereabouts.h"
#include "crossnav/objects/alias.h"
#include "crossnav/objects/room_odds.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using objects::KnownAs;

namespace {

constexpr double kOtherKind = 0.05;   // chosen: of tops for a thing of the ground, and vice versa
constexpr double kMisfit = 0.05;      // chosen: of patches too small for the goal: it may overhang
constexpr double kMostBase_m2 = 0.6;  // chosen: that a base asks for; the cells around hold 1.4 m2
constexpr double kAtOldPlace = 0.25;  // chosen: of things that left their place, near it
constexpr double kOldPlace_m = 1.2;   // chosen: the next place on a table, or beside it

/// Mean height of the category's records above their floor [m]; nullopt without a record.
std::optional<double> UsualHeight(const World& world, const std::string& category) {
  double sum_m = 0;
  int count = 0;
  for (const objects::ObjectRecord& record : world.objects.records()) {
    if (record.category != category || record.views == 0) continue;
    const auto height_m = HeightAboveFloor(world, record);
    if (!height_m) continue;
    sum_m += *height_m;
    ++count;
  }
  return count > 0 ? std::optional(sum_m / count) : std::nullopt;
}

/// Least base among the category's records, without the voxel that a surface may be off [m2]; 0
/// without a record.
double LeastBase(const World& world, const std::string& category) {
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const objects::ObjectRecord& record : world.objects.records()) {
    if (record.category != category || record.views == 0) continue;
    const Vector3d sides_m =
        (record.box_world_m.sizes().array() - world.objects.voxel_m()).max(0).matrix();
    least_m2 = std::min(least_m2, sides_m.x() * sides_m.y());
  }
  return std::isfinite(least_m2) ? std::min(least_m2, kMostBase_m2) : 0;
}

/// Share of the places on the surface around a patch that hold a base of `base_m2`.
double FitOf(const World& world, const VoxelKey& cell, double base_m2) {
  if (base_m2 <= 0) return 1;
  const double voxel_m = world.objects.voxel_m();
  const double around_m2 = ColumnsAround(world.full.field, cell) * voxel_m * voxel_m;
  return std::max(kMisfit, 1 - base_m2 / around_m2);
}

void ScaleTo(double sum, std::map<VoxelKey, double>* shares) {
  double now = 0;
  for (const auto& [cell, share] : *shares) now += share;
  if (now <= 0) return;
  for (auto& [cell, share] : *shares) share *= sum / now;
}

/// Of `shares`, the patches beside the last place of the goal, in sum kAtOldPlace: things are moved
/// on their furniture, too.
std::map<VoxelKey, double> SharesBeside(const World& world, const GoalState& goal,
                                        const std::map<VoxelKey, double>& shares) {
  std::map<VoxelKey, double> beside;
  const auto lost =
      objects::LastLost(world.objects.records(), KnownAs(world.objects.records(), goal.goal));
  for (const auto& [cell, share] : shares) {
    const Vector3d& p_world = world.full.field.patches().at(cell).p_world;
    if (std::any_of(lost.begin(), lost.end(), [&](const objects::ObjectRecord* record) {
          return record->box_world_m.exteriorDistance(p_world) <= kOldPlace_m;
        }))
      beside.emplace(cell, share);
  }
  ScaleTo(kAtOldPlace, &beside);
  return beside;
}

struct Place {
  int room = 0;  ///< 0 without a graph
  double weight = 0;
};

/// Patches that are in a room, by the columns on which the goal may stand.
std::map<VoxelKey, Place> PlacesFor(const World& world, const GoalState& goal) {
  const std::string category = KnownAs(world.objects.records(), goal.goal);
  const auto height_m = UsualHeight(world, category);
  const double base_m2 = LeastBase(world, category);
  const Carriers carriers(world);
  std::map<VoxelKey, Place> places;
  for (const auto& [cell, patch] : world.full.field.patches()) {
    if (goal.full.search->hidden.contains(cell)) continue;
    Place place;
    if (world.revision) {
      const auto& graph = world.revision->graph;
      const auto floor = FloorAt(graph, patch.p_world);
      const auto room = floor ? RoomAt(graph, *floor, patch.p_world) : std::nullopt;
      if (!room) continue;
      place.room = *room;
    }
    const bool is_top = patch.height_m > kFurnitureTop_m;
    place.weight = patch.columns * FitOf(world, cell, base_m2);
    if (is_top) place.weight *= carriers.WeightAt(patch.p_world);
    if (height_m && (*height_m > kFurnitureTop_m) != is_top) place.weight *= kOtherKind;
    places[cell] = place;
  }
  return places;
}

}  // namespace

std::map<int, double> OddsOf(const World& world, const GoalState& goal) {
  const double column_m2 = world.objects.voxel_m() * world.objects.voxel_m();
  std::map<int, double> areas_m2;
  for (const auto& [cell, place] : PlacesFor(world, goal))
    areas_m2[place.room] += place.weight * column_m2;
  std::vector<objects::RoomPlace> rooms;
  for (const auto& room : world.revision->graph.rooms)
    rooms.push_back({room.id, room.floor, areas_m2[room.id]});
  const auto& records = world.objects.records();
  return RoomOdds(records, rooms, KnownAs(records, goal.goal));
}

std::map<VoxelKey, double> SharesOf(const World& world, const GoalState& goal,
                                    const std::map<int, double>& odds) {
  const std::map<VoxelKey, Place> places = PlacesFor(world, goal);
  std::map<VoxelKey, double> shares;
  std::map<int, double> in_room;
  for (const auto& [cell, place] : places) {
    shares[cell] = place.weight;
    in_room[place.room] += place.weight;
  }
  const std::map<VoxelKey, double> beside = SharesBeside(world, goal, shares);
  for (auto& [cell, share] : shares) {
    const int room = places.at(cell).room;
    const auto it = odds.find(room);
    share *= (odds.empty() ? 1 : it == odds.end() ? 0 : it->second) / in_room[room];
  }
  ScaleTo(beside.empty() ? 1 : 1 - kAtOldPlace, &shares);
  for (const auto& [cell, share] : beside) shares[cell] += share;
  return shares;
}

}  // namespace crossnav::agent
