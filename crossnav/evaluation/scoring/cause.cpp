// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/cause.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string_view>

#include "crossnav/evaluation/scoring/outcome.h"

namespace crossnav::evaluation {
namespace {

constexpr double kOffFloor_m = 0.6;  // chosen: more than a sunken room, less than half a storey
constexpr int kFlightPoints = 3;     // chosen: 0.12 m2 of treads; a stray voxel does not count
constexpr int kGroundSlack_vox = 2;  // chosen: the navmesh lies up to a cell off the surface

/// "go_to" of "go_to: no progress"; empty for an event that ends no activity.
std::string_view EndedActivity(std::string_view event) {
  constexpr std::array<std::string_view, 4> kActivities = {"go_to", "climb", "visit", "approach"};
  for (const std::string_view name : kActivities) {
    if (event.starts_with(name) && event.substr(name.size()).starts_with(": ")) return name;
  }
  return {};
}

/// Ending events of policy.profile = paper.
bool IsPaperEnding(std::string_view event) {
  return event == "stairs given up" || event == "entrance rejected" ||
         event == "history POI without success" || event.starts_with("verification failed: ");
}

double HeightOf(const std::vector<sim::Floor>& floors, int id) {
  for (const sim::Floor& floor : floors) {
    if (floor.id == id) return floor.height_m;
  }
  return 0;
}

std::optional<FlightCause> JudgeFlight(const CauseWatch& watch, const SceneContext& context,
                                       const geometry::VoxelMap& map, const StageRecord& stage) {
  const auto goals = context.FloorsOf(stage.goal);
  const auto& navmesh = context.navmesh();
  if (Holds(goals, stage.floor_end)) {
    if (Holds(goals, stage.floor_start)) return std::nullopt;
    return FlightCause{stage.floor_end, stage.floor_end, true, true, true};
  }
  const auto next = NextFloor(navmesh.Connections(), stage.floor_end, goals);
  if (!next) return std::nullopt;
  FlightCause flight{next->first, next->second, false, false, false};
  flight.climbed = watch.HasClimbed(stage.floor_end, flight.floor);
  flight.begun = flight.climbed || watch.HasBegun(stage.floor_end, flight.floor);
  flight.seen = flight.begun || HoldsFlight(map, context.WalkablePoints(),
                                            HeightOf(navmesh.Floors(), stage.floor_end),
                                            HeightOf(navmesh.Floors(), flight.floor));
  return flight;
}

}  // namespace

void CauseWatch::Add(const trace::StepTrace& step, int floor) {
  const bool has_activity = !step.activity.empty();
  const std::string& name = has_activity ? step.activity : step.mode;
  ++cause_.steps[name];
  NoteEvents(step, floor);
  cause_.is_under_way = name != "none";
  if (cause_.is_under_way) cause_.last_activity = name;
  if (name == "climb") NoteTarget(step, floor);
}

void CauseWatch::NoteEvents(const trace::StepTrace& step, int floor) {
  for (const std::string& event : step.events) {
    if (event == "stairs up verified") begun_.insert({floor, 1});
    if (event == "stairs down verified") begun_.insert({floor, -1});
    const std::string_view ended = EndedActivity(event);
    if (!ended.empty()) cause_.last_activity = ended;
    if (!ended.empty() || IsPaperEnding(event)) cause_.last_ending = event;
  }
}

/// A climb is on a flight if its path ends well above or below the floor.
void CauseWatch::NoteTarget(const trace::StepTrace& step, int floor) {
  for (const trace::CandidateTrace& candidate : step.candidates) {
    if (!candidate.is_target) continue;
    const double rise_m = candidate.p_nav_world.z() - HeightOf(floors_, floor);
    if (std::abs(rise_m) >= kOffFloor_m) begun_.insert({floor, rise_m > 0 ? 1 : -1});
  }
}

StageCause CauseWatch::Activities() const {
  return cause_;
}

std::optional<std::pair<int, int>> NextFloor(std::span<const sim::FloorConnection> connections,
                                             int from, const std::vector<int>& goals) {
  if (Holds(goals, from)) return std::nullopt;
  std::map<int, int> first = {{from, from}};  // for each floor: first floor on the path to it
  for (std::deque<int> open = {from}; !open.empty(); open.pop_front()) {
    const int at = open.front();
    if (Holds(goals, at)) return std::pair(first[at], at);
    for (const sim::FloorConnection& link : connections) {
      if (link.lower != at && link.upper != at) continue;
      const int next = link.lower == at ? link.upper : link.lower;
      if (first.emplace(next, at == from ? next : first[at]).second) open.push_back(next);
    }
  }
  return std::nullopt;
}

bool HoldsGround(const geometry::VoxelMap& map, const Vector3d& p_world) {
  geometry::VoxelKey key = geometry::KeyOf(p_world, map.config().voxel_m);
  const int middle = key.z;
  for (key.z = middle - kGroundSlack_vox; key.z <= middle + kGroundSlack_vox; ++key.z) {
    if (geometry::IsSurface(map.StateAt(key))) return true;
  }
  return false;
}

double SeenShare(const geometry::VoxelMap& map, std::span<const Vector3d> walkable_world) {
  if (walkable_world.empty()) return 0;
  const auto seen = std::count_if(walkable_world.begin(), walkable_world.end(),
                                  [&](const Vector3d& p) { return HoldsGround(map, p); });
  return static_cast<double>(seen) / static_cast<double>(walkable_world.size());
}

bool HoldsFlight(const geometry::VoxelMap& map, std::span<const Vector3d> walkable_world,
                 double height_a_m, double height_b_m) {
  const double low_m = std::min(height_a_m, height_b_m) + kOffFloor_m;
  const double high_m = std::max(height_a_m, height_b_m) - kOffFloor_m;
  int seen = 0;
  for (const Vector3d& p : walkable_world) {
    if (p.z() < low_m || p.z() > high_m || !HoldsGround(map, p)) continue;
    if (++seen >= kFlightPoints) return true;
  }
  return false;
}

StageCause JudgeCause(const CauseWatch& watch, const SceneContext& context,
                      const geometry::VoxelMap& map, const StageRecord& stage) {
  StageCause cause = watch.Activities();
  cause.flight = JudgeFlight(watch, context, map, stage);
  cause.seen_share = SeenShare(map, context.WalkablePoints());
  return cause;
}

}  // namespace crossnav::evaluation
