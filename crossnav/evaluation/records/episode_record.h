// SPDX-License-Identifier: MIT
// What the evaluator keeps of one episode: one row per executed stage. The metrics read only this;
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

/// How an executed stage ended, in the benchmark's order of precedence.
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

/// The flight that the agent had still to take, or had taken, for a goal on another floor.
struct FlightCause {
  int floor = 0;       ///< it leads to from where the stage ended: the next one on the way
  int goal_floor = 0;  ///< nearest floor that holds an instance
  bool seen = false;   ///< its ground is in the agent's map
  bool begun = false;  ///< the agent set out on it: a climb, or a stair session
  bool climbed = false;
  friend bool operator==(const FlightCause&, const FlightCause&) = default;
};

/// What a failed stage was doing, for whoever looks into it (cause.h makes it and words it).
struct StageCause {
  std::map<std::string, int> steps;  ///< by activity; by mode where the policy names no activity
  std::string last_activity;         ///< the last that was none but "none"
  bool is_under_way = false;         ///< it had not ended when the stage did
  std::string last_ending;  ///< event of the last activity that ended, e.g. "go_to: no progress"
  std::optional<FlightCause> flight;  ///< where the goal's floors are not all that was walked on
  double seen_share = 0;              ///< of the scene's walkable area that the agent's map holds
  friend bool operator==(const StageCause&, const StageCause&) = default;
};

/// How far a successful stage walked, in parts (gaps.h). Place of reach: since then the agent was
/// within the success radius of the instance that it stopped at.
struct StageReach {
  double walked_m = 0;          ///< until the place of reach
  double reach_shortest_m = 0;  ///< shortest path from the stage's start to the place of reach
  double end_shortest_m = 0;    ///< and to the place of STOP
  friend bool operator==(const StageReach&, const StageReach&) = default;
};

/// What the actions of a stage were.
struct StageWalk {
  int forward = 0, turn = 0, look = 0;
  std::optional<StageReach> reach;  ///< of a successful stage
  friend bool operator==(const StageWalk&, const StageWalk&) = default;
};

/// Beside the outcome, never instead of it.
struct StageExtra {
  bool passed_target = false;  ///< a true instance was in view within the success radius, unclaimed
  bool wrong_floor = false;    ///< ended within the radius of an instance, but on another floor
  /// For a stage whose goal is on other floors only and that failed: never_found,
  /// entrance_rejected, lost_on_flight or landing_not_confirmed. Empty otherwise.
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
  int transitions = 0;  ///< times the agent arrived on another floor
  StageExtra extra;
};

/// EpisodeFailure::reason of an episode that does not fit its scene (start off the navmesh).
inline constexpr std::string_view kInvalidEpisode = "invalid";

/// Why an episode has no result. Metrics count it as not successful; an invalid one, not at all.
struct EpisodeFailure {
  std::string reason;   ///< error, crash, time or invalid
  std::string message;  ///< for people
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
  std::optional<EpisodeFailure> failed;  ///< set: the episode ended without a result, no stages
  // The two fields below are the only ones that may differ between two runs of the same seed.
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

  /// How the episode ended, in a word: the outcome of its last stage, or "failed".
  std::string_view OutcomeName() const {
    if (failed) return "failed";
    if (IsComplete()) return NameOf(Outcome::kSuccess);
    const bool has_ended = !stages.empty() && !stages.back().success;
    return NameOf(has_ended ? stages.back().outcome : Outcome::kOutOfTime);  // no action was left
  }
};

}  // namespace crossnav::evaluation
