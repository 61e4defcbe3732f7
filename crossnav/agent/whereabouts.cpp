// SPDX-License-Identifier: MIT
#include "crossnav/agent/whereabouts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/core/category_table.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using objects::ObjectRecord;

namespace {

constexpr double kStillThere = 0.5;  // chosen: share of a place's voxels that are surfaces
constexpr double kSamePlace = 0.3;   // chosen: share of a place's voxels in a record's box
constexpr int kSampled_vox = 4;      // chosen: cells of the plan that are asked, a chair apart
constexpr double kOpenShare = 0.1;   // chosen: of a room's ground, that is worth going there
constexpr double kSmall_m = 0.6;     // chosen: largest side of a thing that is noticed late
constexpr double kSmallShare = 0.6;  // chosen: of the range, for small things; as the last resort's
constexpr double kMissed = 0.3;      // chosen: chance that the memory misses a thing that was seen

double ShareOfSurfaces(const World& world, const std::vector<VoxelKey>& voxels) {
  const auto count = std::count_if(voxels.begin(), voxels.end(), [&](const VoxelKey& key) {
    return geometry::IsSurface(world.map.StateAt(key));
  });
  return voxels.empty() ? 0 : static_cast<double>(count) / static_cast<double>(voxels.size());
}

/// Share of the place that the record's surface covers.
double ShareCovered(const std::vector<VoxelKey>& voxels, const ObjectRecord& record) {
  const auto covered = std::count_if(voxels.begin(), voxels.end(), [&](const VoxelKey& key) {
    return std::binary_search(record.voxels.begin(), record.voxels.end(), key);
  });
  return voxels.empty() ? 0 : static_cast<double>(covered) / static_cast<double>(voxels.size());
}

/// Share of the smaller of both that lies in the other.
double ShareIn(const World& world, const std::vector<VoxelKey>& voxels,
               const ObjectRecord& record) {
  const double voxel_m = world.objects.voxel_m();
  const auto inside = std::count_if(voxels.begin(), voxels.end(), [&](const VoxelKey& key) {
    return record.box_world_m.contains(geometry::CenterOf(key, voxel_m));
  });
  const auto few = std::min(voxels.size(), record.voxels.size());
  return few == 0 ? 0 : static_cast<double>(inside) / static_cast<double>(few);
}

/// Verdict of the records on a place: 1 believed, -1 gone, 0 no record. A record that is gone
/// speaks for its own surface alone: the object may stand beside its old place.
int OpinionOf(const World& world, const std::vector<VoxelKey>& voxels,
              const std::string& category) {
  int opinion = 0;
  for (const ObjectRecord& record : world.objects.records()) {
    if (record.category != category || ShareIn(world, voxels, record) < kSamePlace) continue;
    if (!world.objects.IsGone(record)) return 1;
    if (ShareCovered(voxels, record) >= kStillThere) opinion = -1;
  }
  return opinion;
}

HistoryPoi PlaceOf(const ObjectRecord& record, double score) {
  HistoryPoi place;
  place.voxels = record.voxels;
  place.p_center_world = record.centre_world_m;
  place.score = score;
  place.similarity = 1;
  return place;
}

/// Shares of a room's ground.
struct Unseen {
  double by_any = 0;   ///< not inspected for any goal of this run
  double by_goal = 0;  ///< chance that the goal stands there unnoticed
};

std::map<int, Unseen> UnseenShares(const World& world, const FullGoal& goal) {
  std::map<int, Unseen> sums;
  std::map<int, int> asked;
  const auto& graph = world.revision->graph;
  for (std::size_t floor = 0; floor < graph.plans.size(); ++floor) {
    const auto& plan = graph.plans[floor];
    const int z = geometry::KeyOf({0, 0, graph.floors[floor].height_m}, graph.voxel_m).z;
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
      const int x = plan.frame.XOf(i), y = plan.frame.YOf(i);
      if (plan.cells[i] < 0 || x % kSampled_vox != 0 || y % kSampled_vox != 0) continue;
      const auto standing = world.ground.StandingNear(x, y, z, kSampled_vox);
      if (!standing) continue;
      const VoxelKey key{x, y, *standing};
      const bool is_open = !world.coverage.IsInspected(key);
      Unseen& sum = sums[plan.cells[i]];
      sum.by_any += is_open;
      sum.by_goal += is_open ? 1 : goal.inspected.IsInspected(key) ? 0 : kMissed;
      ++asked[plan.cells[i]];
    }
  }
  for (auto& [room, sum] : sums) {
    sum.by_any /= asked[room];
    sum.by_goal /= asked[room];
  }
  return sums;
}

}  // namespace

double NoticeRange(const World& world, const GoalState& goal, const Config& config) {
  const std::string category = CanonicalName(goal.goal);
  double side_m = 0;
  for (const ObjectRecord& record : world.objects.records())
    if (record.category == category && record.views > 0)
      side_m = std::max(side_m, record.box_world_m.sizes().maxCoeff());
  const double range_m = config.policy.explore.inspect_range_m;
  return side_m > 0 && side_m < kSmall_m ? kSmallShare * range_m : range_m;
}

bool ClearsOldSurfaces(const Config& config) {
  return config.policy.profile == "full" && !config.policy.planar;
}

bool IsRevising(const Config& config) {
  return config.memory.mode == "revise" && ClearsOldSurfaces(config);
}

Result<void> CountEvidence(geometry::VoxelMap* map) {
  geometry::MapConfig config = map->config();
  config.clearing = "evidence";
  auto blocks = geometry::ExportBlocks(*map);
  for (geometry::MapBlock& block : blocks) geometry::CountEvidence(config, &block);
  auto counted = geometry::ImportBlocks(blocks, config);
  if (!counted) return tl::unexpected(counted.error());
  *map = std::move(*counted);
  return {};
}

Revision RevisionOf(const World& world) {
  Revision revision;
  revision.graph = scenegraph::BuildGraph(world.map, world.memory, world.flights);
  for (const auto& room : revision.graph.rooms)
    revision.rooms.push_back({room.id, room.floor, room.area_m2});
  return revision;
}

void LocateObjects(World* world) {
  if (!world->revision) return;
  const auto& graph = world->revision->graph;
  world->objects.Locate([&](const ObjectRecord& record, int* floor, int* room) {
    *floor = FloorAt(graph, record.centre_world_m).value_or(-1);
    *room = *floor < 0 ? -1 : RoomAt(graph, *floor, record.centre_world_m).value_or(-1);
  });
}

std::vector<HistoryPoi> Revised(std::vector<HistoryPoi> places, const World& world,
                                const GoalState& goal) {
  const std::string category = CanonicalName(goal.goal);
  double best_score = 1;
  for (const HistoryPoi& place : places) best_score = std::max(best_score, place.score);
  std::erase_if(places, [&](const HistoryPoi& place) {
    const int opinion = OpinionOf(world, place.voxels, category);
    return opinion < 0 || (opinion == 0 && ShareOfSurfaces(world, place.voxels) < kStillThere);
  });
  for (const ObjectRecord& record : world.objects.records()) {
    if (record.category != category || world.objects.IsGone(record) || record.views < 2) continue;
    const bool is_covered = std::any_of(places.begin(), places.end(), [&](const HistoryPoi& place) {
      return ShareIn(world, place.voxels, record) >= kSamePlace;
    });
    if (!is_covered) places.push_back(PlaceOf(record, best_score));
  }
  return places;
}

void UpdateSearch(StepState& now) {
  if (!now.world.revision) return;
  auto& search = now.goal.full.search;
  const bool is_fresh = !search;
  const int every = now.config.policy.explore.reconsider_steps;
  if (!is_fresh && now.world.step - search->step < every) return;
  if (is_fresh) {
    LocateObjects(&now.world);
    search.emplace();
    search->odds = RoomOdds(now.world.objects.records(), now.world.revision->rooms,
                            CanonicalName(now.goal.goal));
  }
  search->step = now.world.step;
  search->mean = search->unseen = 0;
  int open = 0;
  const auto shares = UnseenShares(now.world, now.goal.full);
  for (const auto& [room, odds] : search->odds) {
    const auto it = shares.find(room);
    if (it == shares.end()) continue;
    if (it->second.by_goal >= kOpenShare) search->unseen += odds * it->second.by_goal;
    if (it->second.by_any < kOpenShare) continue;
    search->mean += odds;
    ++open;
  }
  if (open > 0) search->mean /= open;
}

double SearchBonus(const Situation& now, const Vector3d& p_world) {
  const auto& search = now.goal.full.search;
  if (!search || search->mean <= 0) return 0;
  const auto& graph = now.world.revision->graph;
  const auto floor = FloorAt(graph, p_world);
  const auto room = floor ? RoomAt(graph, *floor, p_world) : std::nullopt;
  if (!room) return 0;
  const auto it = search->odds.find(*room);
  if (it == search->odds.end()) return 0;
  const MemoryConfig& config = now.config.memory;
  const double bits = std::log2(it->second / search->mean);
  return config.search_m_per_bit *
         std::clamp(bits, -config.search_most_bits, config.search_most_bits);
}

bool IsSurelyAbsent(const Situation& now) {
  const auto& search = now.goal.full.search;
  return search && objects::OddsOfAbsence(search->unseen) >= now.config.memory.absent_from;
}

}  // namespace crossnav::agent
