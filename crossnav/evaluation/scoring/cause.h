// SPDX-License-Identifier: MIT
// Cause of a failed stage, from the step traces, the agent's map and the true floors: follows a
// stage, sums it up, words it and counts it. Judges only: the agent cannot see it. World frame,
// metres.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::evaluation {

/// Follows one stage: the agent's activities and flights.
class CauseWatch {
 public:
  explicit CauseWatch(const std::vector<sim::Floor>& floors) : floors_(floors) {}

  /// Adds a step on floor `floor` (on a flight: the last floor).
  void Add(const trace::StepTrace& step, int floor);
  /// The agent arrived on floor `to`.
  void Arrive(int from, int to) { climbed_.insert({from, to}); }

  /// Steps and activities; the caller fills in flight and seen_share.
  StageCause Activities() const;
  bool HasBegun(int from, int to) const { return begun_.count({from, to > from ? 1 : -1}) > 0; }
  bool HasClimbed(int from, int to) const { return climbed_.count({from, to}) > 0; }

 private:
  void NoteEvents(const trace::StepTrace& step, int floor);
  void NoteTarget(const trace::StepTrace& step, int floor);

  std::vector<sim::Floor> floors_;
  StageCause cause_;
  std::set<std::pair<int, int>> begun_;    // floor, +1 up or -1 down
  std::set<std::pair<int, int>> climbed_;  // from, to
};

/// First floor on the shortest path over `connections` from `from` to one of `goals`, and that goal
/// floor; empty without a path, or if `from` is a goal floor.
std::optional<std::pair<int, int>> NextFloor(std::span<const sim::FloorConnection> connections,
                                             int from, const std::vector<int>& goals);

/// Whether `map` holds the ground at `p_world`: a surface within two voxels of it.
bool HoldsGround(const geometry::VoxelMap& map, const Vector3d& p_world);
/// Share of `walkable_world` whose ground `map` holds; 0 where there is none.
double SeenShare(const geometry::VoxelMap& map, std::span<const Vector3d> walkable_world);
/// Whether `map` holds ground of a flight: walkable points well between the two heights.
bool HoldsFlight(const geometry::VoxelMap& map, std::span<const Vector3d> walkable_world,
                 double height_a_m, double height_b_m);

/// Sums up a failed stage; `stage` is complete except for its cause.
StageCause JudgeCause(const CauseWatch& watch, const SceneContext& context,
                      const geometry::VoxelMap& map, const StageRecord& stage);

/// Name under which a failed stage is counted; empty for a success, "unknown" for records without a
/// cause. Precedence: stopped at the wrong place, passed the goal, missed the flight, else the last
/// activity that ended.
std::string CauseOf(const StageRecord& stage);

/// "EPISODE: bed out_of_time after 1200 | last go_to, ended: no progress | ..." for each failed
/// stage with a cause.
std::vector<std::string> CauseLines(const EpisodeRecord& episode);

/// Failed stages of a cause.
struct CauseCount {
  int stages = 0;
  std::array<int, kOutcomeNames.size()> outcomes{};
  double seen_share = 0;  ///< mean
};
std::map<std::string, CauseCount> CountCauses(std::span<const EpisodeRecord> episodes);

}  // namespace crossnav::evaluation
