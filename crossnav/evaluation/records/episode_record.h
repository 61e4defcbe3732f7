// SPDX-License-Identifier: MIT
// The evaluator's record of an episode: one row per executed stage. The metrics read only this;
// result_records.h writes it to disk. World frame, metres.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::evaluation {

/// Outcome of an executed stage, in the benchmark's order of precedence.
enum class Outcome { kSuccess, kNotReached, kMisdetection, kAllExplored, kStuck, kOutOfTime };

inline constexpr std::array<std::string_view, 6> kOutcomeNames = {
    "success", "not_reached", "misdetection", "all_explored", "stuck", "out_of_time"};

inline std::string_view NameOf(Outcome outcome) {
  return kOutcomeNames[static_cast<std::size_t>(outcome)];
}

inline std::optional<Outcome> OutcomeFromName(std::string_view name) {
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    if (kOutcomeNames[i] == name) return static_cast<Outcome>(i);
  }
  return std::nullopt;
}

/// The flight towards a goal on another floor, not yet or already taken.
struct FlightCause {
  int floor = 0;       ///< next floor on the path from the end of the stage
  int goal_floor = 0;  ///< nearest floor that holds an instance
  bool seen = false;   ///< its ground is in the agent's map
  bool begun = false;  ///< a pursuit of it began: a climb, or a stair session
  bool climbed = false;
  friend bool operator==(const FlightCause&, const FlightCause&) = default;
};

/// Activity of a failed stage, for diagnosis (cause.h makes and words it).
struct StageCause {
  std::map<std::string, int> steps;  ///< by activity; by mode where the policy names no activity
  std::string last_activity;         ///< the last activity other than "none"
  bool is_under_way = false;         ///< it had not ended at the end of the stage
  std::string last_ending;  ///< event of the last activity that ended, e.g. "go_to: no progress"
  std::optional<FlightCause> flight;  ///< set if a floor of the goal was not walked on
  double seen_share = 0;              ///< share of the scene's walkable area in the agent's map
  friend bool operator==(const StageCause&, const StageCause&) = default;
};

/// Parts of the path of a successful stage (gaps.h). Place of reach: the first place after which
/// the agent stayed within the success radius of its final instance.
struct StageReach {
  double walked_m = 0;          ///< until the place of reach
  double reach_shortest_m = 0;  ///< shortest path from the stage's start to the place of reach
  double end_shortest_m = 0;    ///< and to the place of STOP
  friend bool operator==(const StageReach&, const StageReach&) = default;
};

/// Actions of a stage.
struct StageWalk {
  int forward = 0, turn = 0, look = 0;
  std::optional<StageReach> reach;  ///< of a successful stage
  friend bool operator==(const StageWalk&, const StageWalk&) = default;
};

/// Diagnosis in addition to the outcome.
struct StageExtra {
  bool passed_target = false;  ///< a true instance was in view within the success radius, unclaimed
  bool wrong_floor = false;    ///< ended within the radius of an instance, but on another floor
  /// For a failed stage with goals on other floors only: never_found, entrance_rejected,
  /// lost_on_flight or landing_not_confirmed. Empty otherwise.
  std::string stairs;
  std::optional<double> distance_to_goal_m;  ///< geodesic, from the end to the nearest viewpoint
  std::optional<StageCause> cause;           ///< of failed stages; old records lack it
  std::optional<StageWalk> walk;             ///< old records lack it
};

struct StageRecord {
  std::string goal;
  Outcome outcome = Outcome::kOutOfTime;
  bool success = false;
  Vector3d start_world = Vector3d::Zero();
  Vector3d end_world = Vector3d::Zero();
  double shortest_m = 0;  ///< d*, eq:posthoc_distance
  double length_m = 0;    ///< sum of 3D displacements
  int actions = 0;
  int floor_start = 0, floor_end = 0;
  int transitions = 0;  ///< arrivals on another floor
  StageExtra extra;
};

/// EpisodeFailure::reason of an episode that does not fit its scene (start off the navmesh).
inline constexpr std::string_view kInvalidEpisode = "invalid";

/// Reason for an episode without a result. Metrics count it as not successful; an invalid episode
/// is not counted.
struct EpisodeFailure {
  std::string reason;   ///< error, crash, time or invalid
  std::string message;  ///< free text
};

struct StageTiming {
  double p50 = 0, p95 = 0;  ///< CPU time [ms]
};

struct EpisodeRecord {
  std::string episode_id;
  std::string scene_id;
  std::string track;  ///< origin of the building (suite.h), or empty
  bool cross_floor_required = false;
  int first_transition_stage = 0;  ///< from 1; 0 = none required
  std::vector<std::string> goals;
  int actions = 0;
  std::vector<StageRecord> stages;       ///< executed stages only, in order
  std::optional<EpisodeFailure> failed;  ///< set: no result, no stages
  // Only these two fields may differ between runs of the same seed.
  double wall_s = 0;
  std::map<std::string, StageTiming> timing_ms;

  /// Length m of the completed prefix.
  int Completed() const {
    int completed = 0;
    for (const StageRecord& stage : stages) {
      if (!stage.success) break;
      ++completed;
    }
    return completed;
  }
  bool IsComplete() const { return Completed() == static_cast<int>(goals.size()); }

  /// Outcome of the episode in a word: the outcome of its last stage, or "failed".
  std::string_view OutcomeName() const {
    if (failed) return "failed";
    if (IsComplete()) return NameOf(Outcome::kSuccess);
    const bool has_ended = !stages.empty() && !stages.back().success;
    return NameOf(has_ended ? stages.back().outcome : Outcome::kOutOfTime);  // no action left
  }
};

}  // namespace crossnav::evaluation
