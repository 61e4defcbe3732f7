// SPDX-License-Identifier: MIT
#include "crossnav/agent/search_shares.h"

#include <algorithm>
#include <optional>
#include <string>

#include "crossnav/objects/alias.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using objects::KnownAs;

namespace {

constexpr double kOtherKind = 0.05;   // chosen: of tops for a thing of the ground, and vice versa
constexpr double kAtOldPlace = 0.25;  // chosen: of things that left their place, near it
constexpr double kOldPlace_m = 1.2;   // chosen: the next place on a table, or beside it

/// Mean height of the category's records above their floor [m]; nullopt without a record.
std::optional<double> UsualHeight(const World& world, const std::string& category) {
  double sum_m = 0;
  int count = 0;
  for (const objects::ObjectRecord& record : world.objects.records()) {
    if (record.category != category || record.views == 0 || !world.revision) continue;
    const auto& floors = world.revision->graph.floors;
    const auto floor = FloorAt(world.revision->graph, record.centre_world_m);
    if (!floor) continue;
    sum_m += record.box_world_m.min().z() - floors[static_cast<std::size_t>(*floor)].height_m;
    ++count;
  }
  return count > 0 ? std::optional(sum_m / count) : std::nullopt;
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

}  // namespace

std::map<VoxelKey, double> SharesOf(const World& world, const GoalState& goal,
                                    const std::map<int, double>& odds) {
  const auto height_m = UsualHeight(world, KnownAs(world.objects.records(), goal.goal));
  std::map<VoxelKey, double> shares;
  std::map<VoxelKey, int> rooms;
  std::map<int, double> in_room;
  for (const auto& [cell, patch] : world.full.field.patches()) {
    if (goal.full.search->hidden.contains(cell)) continue;
    double share = patch.columns;
    if (height_m && (*height_m > kFurnitureTop_m) != (patch.height_m > kFurnitureTop_m))
      share *= kOtherKind;
    if (world.revision) {
      const auto& graph = world.revision->graph;
      const auto floor = FloorAt(graph, patch.p_world);
      const auto room = floor ? RoomAt(graph, *floor, patch.p_world) : std::nullopt;
      if (!room) continue;
      rooms[cell] = *room;
      in_room[*room] += share;
    } else {
      in_room[0] += share;
    }
    shares[cell] = share;
  }
  const std::map<VoxelKey, double> beside = SharesBeside(world, goal, shares);
  for (auto& [cell, share] : shares) {
    const int room = world.revision ? rooms[cell] : 0;
    const auto it = odds.find(room);
    share *= (odds.empty() ? 1 : it == odds.end() ? 0 : it->second) / in_room[room];
  }
  ScaleTo(beside.empty() ? 1 : 1 - kAtOldPlace, &shares);
  for (const auto& [cell, share] : beside) shares[cell] += share;
  return shares;
}

}  // namespace crossnav::agent
