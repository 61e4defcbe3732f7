// SPDX-License-Identifier: MIT
// Visits to houses on several days, and their results. Each goal has a track: stayed, moved
// overnight, gone, or behind a closed door. Files: docs/formats/visits.md. World frame, metres.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/core/result.h"
#include "crossnav/evaluation/records/episode_record.h"

namespace crossnav::evaluation {

/// Goals of the first day have the track "first", because no memory exists yet.
inline constexpr std::array<std::string_view, 8> kVisitTracks = {
    "first",      "static",      "same_furniture", "other_furniture",
    "other_room", "other_floor", "removed",        "doors"};

struct VisitGoal {
  std::string goal;  ///< a category, or a raw name
  std::string track;
  bool is_absent = false;             ///< success = declared absent: no candidate is left
  std::vector<int> floors;            ///< certificate: floors with a reachable instance
  std::vector<Vector3d> stale_world;  ///< places of an instance on an earlier day, none now
  friend bool operator==(const VisitGoal&, const VisitGoal&) = default;
};

struct HouseVisit {
  std::string house;  ///< id of its first day
  int day = 0;
  std::string scene_id;  ///< of the day
  AgentPose start;
  std::vector<VisitGoal> goals;

  std::string Id() const { return house + "/" + std::to_string(day); }
};

/// Visits of a house are consecutive, by day.
struct VisitFile {
  std::vector<HouseVisit> visits;
  std::string content_hash;  ///< of the text
};

/// Goals that are no category leave the visits: a network has classes, and only ground truth knows
/// one object by its raw name. Returns the number of goals that left.
int LeaveOutNames(std::vector<HouseVisit>* visits);

std::string VisitsText(const std::vector<HouseVisit>& visits);
/// Error: malformed, with `where` and the key; days of a house out of order.
Result<VisitFile> ParseVisits(std::string_view text, const std::string& where);
Result<VisitFile> ReadVisits(const std::filesystem::path& path);

/// How the search for one goal ended.
struct GoalRecord {
  std::string goal, track;
  bool is_absent = false;
  Outcome outcome = Outcome::kOutOfTime;  ///< for an absent goal, success = declared absent
  bool success = false;
  double shortest_m = 0;  ///< from the previous stop; 0 for an absent goal
  double length_m = 0;
  int actions = 0, budget = 0;
  int stale_visits = 0;   ///< departures for a stale place
  int revised_after = 0;  ///< actions until the last pursuit of a stale place; 0 = none
  friend bool operator==(const GoalRecord&, const GoalRecord&) = default;

  double Spl() const;  ///< 0 without success
};

struct VisitRecord {
  std::string house;
  int day = 0;
  std::vector<GoalRecord> goals;
  std::int64_t map_bytes = 0;  ///< of the memory saved after the visit
  std::string failure;         ///< reason of a visit without goals; empty = played
};

/// Fields that must be equal for two runs to be compared.
struct VisitRun {
  std::string suite_hash, memory_mode, variant, config_hash, perception, version;
  friend bool operator==(const VisitRun&, const VisitRun&) = default;
};

struct VisitResults {
  VisitRun run;
  std::vector<VisitRecord> records;  ///< by house and day
};

/// JSON Lines: the run, then one line per visit.
std::string VisitResultsText(const VisitResults& results);
Result<VisitResults> ParseVisitResults(std::string_view text, const std::string& where);
/// Drops the records of houses with a failed visit (a full disk, a killed process) and returns the
/// number of these houses: a run that goes on plays them again.
int DropFailedHouses(VisitResults* results);
/// Keeps the first `count` goals of each visit. A search does not know of the goals after it; but
/// the memories of earlier days are of whole visits, and know more than shorter ones would.
void KeepFirstGoals(int count, VisitResults* results);
std::string VisitLine(const VisitRecord& record);
Result<VisitRecord> ParseVisitLine(const std::string& line, const std::string& where);

}  // namespace crossnav::evaluation
