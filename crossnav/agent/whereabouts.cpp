// SPDX-License-Identifier: MIT
#include "crossnav/agent/whereabouts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/core/category_table.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/objects/alias.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using objects::ObjectRecord;

namespace {

constexpr double kStillThere = 0.5;        // chosen: share of a place's voxels that are surfaces
constexpr double kSamePlace = 0.3;         // chosen: share of a place's voxels in a record's box
constexpr double kNoticed_rad = 1.0 / 12;  // chosen: least size in the picture, 5 degrees
constexpr double kLeastNotice_m = 2.0;     // chosen: the smallest things are met that near
constexpr double kUnknown = 0.6;           // chosen: of the range of things that are not small
constexpr double kUnknownMissed = 0.3;     // chosen: chance that such a thing is missed beyond it
constexpr int kLeastViews = 2;             // chosen: frames of a record, as for a live POI
constexpr double kFirst = 2;               // chosen: more than the places that count alike
constexpr double kOffLevel_m = 0.3;        // chosen: of one floor
constexpr double kNewFloor_m = 2.0;  // chosen: as far from each known floor, it is another one
constexpr double kGrown = 0.02;      // chosen: of a map that shows a new room
constexpr double kIsMoved = 0.8;     // chosen: chance that a new object is a known one moved

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

/// Whether the record is new today in a room that was known before: something was carried there.
bool HasAppeared(const ObjectRecord& record, const World& world) {
  if (record.first_seen_day != world.day || !world.revision) return false;
  const auto& graph = world.revision->loaded;
  const auto floor = FloorAt(graph, record.centre_world_m);
  return floor && RoomAt(graph, *floor, record.centre_world_m);
}

/// Chance that the record's object is still there. Where others of its category appeared today,
/// and this one was not seen today, it may be one of them.
double BeliefIn(const ObjectRecord& record, const World& world) {
  if (record.last_seen_day == world.day) return record.confidence;
  int unseen = 0, appeared = 0;
  for (const ObjectRecord& other : world.objects.records()) {
    if (other.category != record.category || other.views < kLeastViews ||
        world.objects.IsGone(other))
      continue;
    unseen += other.last_seen_day < world.day ? 1 : 0;
    appeared += HasAppeared(other, world) ? 1 : 0;
  }
  return record.confidence * (1 - kIsMoved * std::min(1.0, 1.0 * appeared / unseen));
}

double BestScore(const std::vector<HistoryPoi>& places) {
  double best = 1;
  for (const HistoryPoi& place : places) best = std::max(best, place.score);
  return best;
}

void CutRooms(const World& world, Revision* revision) {
  revision->graph = scenegraph::BuildGraph(world.map, world.memory, world.flights);
  revision->known_voxels = world.map.Stats().known;
}

bool HasRecordOf(const World& world, const std::string& category) {
  const auto& records = world.objects.records();
  return std::any_of(records.begin(), records.end(), [&](const ObjectRecord& record) {
    return record.category == category && record.views >= kLeastViews;
  });
}

/// Adds the record's place, instead of places of the memory that are on it: a small thing answers
/// weakly there, because its voxels show its table, too.
void AddPlace(const World& world, const ObjectRecord& record, double score,
              std::vector<HistoryPoi>* places) {
  std::erase_if(*places, [&](const HistoryPoi& place) {
    return place.score < score && ShareIn(world, place.voxels, record) >= kSamePlace;
  });
  places->push_back(PlaceOf(record, score));
}

}  // namespace

Vector3d UsualSides(const World& world, const std::string& category) {
  Vector3d sides_m = Vector3d::Zero();
  for (const ObjectRecord& record : world.objects.records())
    if (record.category == category && record.views > 0)
      sides_m = sides_m.cwiseMax(record.box_world_m.sizes());
  return sides_m;
}

NoticeRanges RangesOfNotice(const World& world, const GoalState& goal, const Config& config) {
  const Vector3d box_m = UsualSides(world, objects::KnownAs(world.objects.records(), goal.goal));
  const double most_m = config.policy.explore.inspect_range_m;
  // A thing that was not met in a known house is small, or nobody has looked for it.
  if (box_m.maxCoeff() <= 0) return {most_m, kUnknown * most_m, kUnknownMissed};
  // Surfaces lie anywhere in their voxels: the box is up to a voxel larger than the thing.
  const double voxel_m = world.objects.voxel_m();
  const Vector3d likely_m = box_m.array() - 0.5 * voxel_m;
  const double from_front_m = std::sqrt(likely_m.head<2>().maxCoeff() * likely_m.z());
  const Vector3d sides_m = (box_m.array() - voxel_m).max(0.5 * voxel_m);
  const double from_any_side_m = std::sqrt(std::sqrt(sides_m.x() * sides_m.y()) * sides_m.z());
  const auto range = [&](double size_m) {
    return std::min(most_m, std::max(kLeastNotice_m, size_m / kNoticed_rad));
  };
  return {range(from_front_m), range(from_any_side_m)};
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

std::optional<double> HeightAboveFloor(const World& world, const ObjectRecord& record) {
  if (!world.revision) return std::nullopt;
  const auto& graph = world.revision->graph;
  const auto floor = FloorAt(graph, record.centre_world_m);
  if (!floor) return std::nullopt;
  return record.box_world_m.min().z() - graph.floors[static_cast<std::size_t>(*floor)].height_m;
}

Revision RevisionOf(const World& world) {
  Revision revision;
  CutRooms(world, &revision);
  revision.loaded = revision.graph;
  return revision;
}

bool UpdateRooms(World* world) {
  if (!world->revision) return false;
  const auto known = static_cast<double>(world->map.Stats().known);
  if (known < (1 + kGrown) * static_cast<double>(world->revision->known_voxels)) return false;
  CutRooms(*world, &*world->revision);
  return true;
}

bool IsOnFloor(const World& world, double z_m) {
  const auto is_at = [&](double level_m) { return std::abs(z_m - level_m) <= kOffLevel_m; };
  if (std::any_of(world.levels_m.begin(), world.levels_m.end(), is_at)) return true;
  return world.revision &&
         std::any_of(world.revision->graph.floors.begin(), world.revision->graph.floors.end(),
                     [&](const auto& floor) { return is_at(floor.height_m); });
}

bool StandsOnFloor(const Situation& now) {
  const World& world = now.world;
  if (!world.has_level || std::abs(now.agent.p_world.z() - world.level_m) >= kOffLevel_m)
    return false;
  if (!world.revision) return true;
  double least_m = kNewFloor_m;
  for (const auto& floor : world.revision->graph.floors)
    least_m = std::min(least_m, std::abs(floor.height_m - world.level_m));
  return least_m <= kOffLevel_m || least_m >= kNewFloor_m;  // between both it is a landing
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
                                const GoalState& goal, bool notices_things) {
  const std::string category = objects::KnownAs(world.objects.records(), goal.goal);
  const bool is_complete = notices_things && HasRecordOf(world, category);
  const double score = kFirst * BestScore(places);
  std::erase_if(places, [&](const HistoryPoi& place) {
    const int opinion = OpinionOf(world, place.voxels, category);
    return opinion < 0 ||
           (opinion == 0 && (is_complete || ShareOfSurfaces(world, place.voxels) < kStillThere));
  });
  for (const ObjectRecord& record : world.objects.records())
    if (record.category == category && record.views >= kLeastViews &&
        !world.objects.IsGone(record)) {
      AddPlace(world, record, score, &places);
      places.back().belief = BeliefIn(record, world);
    }
  return places;
}

std::vector<HistoryPoi> WithRecords(std::vector<HistoryPoi> places, const World& world,
                                    const GoalState& goal) {
  const std::string category = objects::KnownAs(world.objects.records(), goal.goal);
  const double score = kFirst * BestScore(places);
  for (const ObjectRecord& record : world.objects.records()) {
    const bool is_believed = world.has_loaded_objects || !world.objects.IsGone(record);
    if (record.category == category && record.views >= kLeastViews && is_believed)
      AddPlace(world, record, score, &places);
  }
  return places;
}

bool IsBelieved(const World& world, const GoalState& goal, const HistoryPoi& place) {
  return OpinionOf(world, place.voxels, objects::KnownAs(world.objects.records(), goal.goal)) > 0;
}

bool HasRecord(const World& world, const GoalState& goal) {
  return HasRecordOf(world, objects::KnownAs(world.objects.records(), goal.goal));
}

bool IsAnotherThing(const World& world, const GoalState& goal, const HistoryPoi& place) {
  const auto& records = world.objects.records();
  const std::string category = objects::KnownAs(records, goal.goal);
  return std::any_of(records.begin(), records.end(), [&](const ObjectRecord& record) {
    return record.category != category && record.views >= kLeastViews &&
           !world.objects.IsGone(record) && ShareCovered(place.voxels, record) >= kStillThere;
  });
}

bool IsShownAsAnother(const World& world, const GoalState& goal, const HistoryPoi& place) {
  const std::string asked = SpacedName(goal.goal);
  bool is_shown = false;
  for (const ObjectRecord& record : world.objects.records()) {
    const bool is_in_frame = record.views > 0 && record.last_seen_day == world.day &&
                             record.last_seen_step == world.step;
    const bool is_asked = record.category == asked;
    const bool counts = is_in_frame || (is_asked && !world.objects.IsGone(record));
    if (!counts || ShareIn(world, place.voxels, record) < kStillThere) continue;
    if (is_asked) return false;
    is_shown = true;
  }
  return is_shown;
}

void SettlePlaceOf(const ObjectRecord& record, GoalState* goal) {
  for (HistoryPoi& place : goal->history)
    place.is_exhausted |= ShareCovered(place.voxels, record) >= kStillThere;
}

}  // namespace crossnav::agent
