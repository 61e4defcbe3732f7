// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visits.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "crossnav/core/categories.h"
#include "crossnav/core/lines.h"
#include "crossnav/core/read_file.h"
#include "crossnav/core/rng.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/evaluation/records/result_line.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {
namespace {

constexpr int kVisitFormat = 1;

Json PointJson(const Vector3d& p) {
  const auto rounded = [](double m) { return std::round(m * 1e4) / 1e4; };
  return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

Json ToJson(const VisitGoal& goal) {
  Json stale = Json::array();
  for (const Vector3d& p : goal.stale_world) stale.push_back(PointJson(p));
  Json json = {{"goal", goal.goal}, {"track", goal.track}};
  if (goal.is_absent) json["absent"] = true;
  json["floors"] = goal.floors;
  if (!goal.stale_world.empty()) json["stale"] = std::move(stale);
  return json;
}

Vector3d ReadPoint(const Json& json, const std::string& where, std::optional<Error>& error) {
  Vector3d p = Vector3d::Zero();
  const auto bad = [&] {
    if (!error) error = Error{ErrorCode::kMalformed, "is not three finite numbers", where};
    return Vector3d(Vector3d::Zero());
  };
  if (!json.is_array() || json.size() != 3) return bad();
  for (int i = 0; i < 3; ++i) {
    const Json& value = json[static_cast<std::size_t>(i)];
    if (!value.is_number()) return bad();
    p[i] = value.get<double>();
    if (!std::isfinite(p[i])) return bad();
  }
  return p;
}

bool IsTrack(const std::string& track) {
  return std::find(kVisitTracks.begin(), kVisitTracks.end(), track) != kVisitTracks.end();
}

VisitGoal ReadGoal(const Json& json, const std::string& where, std::optional<Error>& error) {
  const ResultLine line(json, where);
  VisitGoal goal;
  Take(line.Get<std::string>("goal"), goal.goal, error);
  Take(line.Get<std::string>("track"), goal.track, error);
  Take(line.GetOr<bool>("absent", false), goal.is_absent, error);
  Take(line.Get<std::vector<int>>("floors"), goal.floors, error);
  if (!error && !IsTrack(goal.track)) {
    error = Error{ErrorCode::kMalformed, "is no track", where + ": track"};
  }
  if (const auto stale = json.find("stale"); stale != json.end() && stale->is_array()) {
    for (const Json& p : *stale) goal.stale_world.push_back(ReadPoint(p, where + ": stale", error));
  }
  return goal;
}

HouseVisit ReadVisit(const Json& json, const std::string& where, std::optional<Error>& error) {
  const ResultLine line(json, where);
  HouseVisit visit;
  double yaw_rad = 0;
  Take(line.Get<std::string>("house"), visit.house, error);
  Take(line.Get<int>("day"), visit.day, error);
  Take(line.Get<std::string>("scene"), visit.scene_id, error);
  Take(line.Get<double>("yaw_rad"), yaw_rad, error);
  visit.start.yaw_rad = yaw_rad;
  const auto start = json.find("start");
  visit.start.p_world = ReadPoint(start == json.end() ? Json() : *start, where + ": start", error);
  const auto goals = json.find("goals");
  if (goals == json.end() || !goals->is_array() || goals->empty()) {
    if (!error) error = Error{ErrorCode::kMalformed, "is no list of goals", where + ": goals"};
    return visit;
  }
  for (std::size_t i = 0; i < goals->size() && !error; ++i) {
    visit.goals.push_back(
        ReadGoal((*goals)[i], where + ": goals[" + std::to_string(i) + "]", error));
  }
  return visit;
}

Json ToJson(const GoalRecord& goal) {
  Json json = {{"goal", goal.goal}, {"track", goal.track}};
  if (goal.is_absent) json["absent"] = true;
  json["outcome"] = NameOf(goal.outcome);
  json["success"] = goal.success;
  json["shortest_m"] = goal.shortest_m;
  json["length_m"] = goal.length_m;
  json["actions"] = goal.actions;
  json["budget"] = goal.budget;
  json["stale_visits"] = goal.stale_visits;
  json["revised_after"] = goal.revised_after;
  return json;
}

GoalRecord ReadGoalRecord(const Json& json, const std::string& where, std::optional<Error>& error) {
  const ResultLine line(json, where);
  GoalRecord goal;
  std::string outcome;
  Take(line.Get<std::string>("goal"), goal.goal, error);
  Take(line.Get<std::string>("track"), goal.track, error);
  Take(line.GetOr<bool>("absent", false), goal.is_absent, error);
  Take(line.Get<std::string>("outcome"), outcome, error);
  Take(line.Get<bool>("success"), goal.success, error);
  Take(line.Get<double>("shortest_m"), goal.shortest_m, error);
  Take(line.Get<double>("length_m"), goal.length_m, error);
  Take(line.Get<int>("actions"), goal.actions, error);
  Take(line.Get<int>("budget"), goal.budget, error);
  Take(line.Get<int>("stale_visits"), goal.stale_visits, error);
  Take(line.Get<int>("revised_after"), goal.revised_after, error);
  const auto known = OutcomeFromName(outcome);
  if (!error && !(known && IsTrack(goal.track))) {
    error = Error{ErrorCode::kMalformed, "has no known outcome and track", where};
  }
  goal.outcome = known.value_or(Outcome::kOutOfTime);
  return goal;
}

Result<Json> ParseObject(std::string_view text, const std::string& where) {
  if (auto ok = CheckJsonShape(text, where); !ok) return tl::unexpected(ok.error());
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return Fail(ErrorCode::kMalformed, "is no JSON object", where);
  return json;
}

Result<void> CheckFormat(const Json& json, const std::string& where) {
  const auto format = json.find("format");
  if (format != json.end() && *format == kVisitFormat) return {};
  return Fail(ErrorCode::kUnsupported, "is missing or of another version", where + ": format");
}

}  // namespace

int LeaveOutNames(std::vector<HouseVisit>* visits) {
  std::size_t left = 0;
  for (HouseVisit& visit : *visits)
    left += std::erase_if(visit.goals, [](const auto& goal) { return !IsCategory(goal.goal); });
  return static_cast<int>(left);
}

std::string VisitsText(const std::vector<HouseVisit>& visits) {
  Json list = Json::array();
  for (const HouseVisit& visit : visits) {
    Json goals = Json::array();
    for (const VisitGoal& goal : visit.goals) goals.push_back(ToJson(goal));
    list.push_back({{"house", visit.house},
                    {"day", visit.day},
                    {"scene", visit.scene_id},
                    {"start", PointJson(visit.start.p_world)},
                    {"yaw_rad", visit.start.yaw_rad},
                    {"goals", std::move(goals)}});
  }
  const Json json = {{"format", kVisitFormat}, {"visits", std::move(list)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<VisitFile> ParseVisits(std::string_view text, const std::string& where) {
  const auto json = ParseObject(text, where);
  if (!json) return tl::unexpected(json.error());
  if (auto ok = CheckFormat(*json, where); !ok) return tl::unexpected(ok.error());
  const auto visits = json->find("visits");
  if (visits == json->end() || !visits->is_array()) {
    return Fail(ErrorCode::kMalformed, "is no list", where + ": visits");
  }
  VisitFile file;
  file.content_hash = HexHash(HashString(text));
  std::map<std::string, int> last_day;
  std::optional<Error> error;
  for (std::size_t i = 0; i < visits->size(); ++i) {
    const std::string at = where + ": visits[" + std::to_string(i) + "]";
    HouseVisit visit = ReadVisit((*visits)[i], at, error);
    if (error) return tl::unexpected(*error);
    const auto [known, is_new] = last_day.try_emplace(visit.house, visit.day);
    if (!is_new && visit.day <= known->second) {
      return Fail(ErrorCode::kMalformed, "is not after the day before", at + ": day");
    }
    known->second = visit.day;
    file.visits.push_back(std::move(visit));
  }
  return file;
}

Result<VisitFile> ReadVisits(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseVisits(*text, path.string());
}

double GoalRecord::Spl() const {
  if (!success) return 0;
  const double longest_m = std::max(shortest_m, length_m);
  return longest_m <= 0 ? 1 : shortest_m / longest_m;
}

int DropFailedHouses(VisitResults* results) {
  std::set<std::string> failed;
  for (const VisitRecord& record : results->records)
    if (!record.failure.empty()) failed.insert(record.house);
  std::erase_if(results->records,
                [&](const VisitRecord& record) { return failed.contains(record.house); });
  return static_cast<int>(failed.size());
}

void KeepFirstGoals(int count, VisitResults* results) {
  for (VisitRecord& record : results->records)
    record.goals.resize(std::min(record.goals.size(), static_cast<std::size_t>(count)));
}

std::string VisitLine(const VisitRecord& record) {
  Json goals = Json::array();
  for (const GoalRecord& goal : record.goals) goals.push_back(ToJson(goal));
  Json json = {{"house", record.house},
               {"day", record.day},
               {"map_bytes", record.map_bytes},
               {"goals", std::move(goals)}};
  if (!record.failure.empty()) json["failure"] = record.failure;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<VisitRecord> ParseVisitLine(const std::string& text, const std::string& where) {
  const auto json = ParseObject(text, where);
  if (!json) return tl::unexpected(json.error());
  const ResultLine line(*json, where);
  VisitRecord record;
  std::optional<Error> error;
  Take(line.Get<std::string>("house"), record.house, error);
  Take(line.Get<int>("day"), record.day, error);
  Take(line.Get<std::int64_t>("map_bytes"), record.map_bytes, error);
  Take(line.GetOr<std::string>("failure", ""), record.failure, error);
  const auto goals = json->find("goals");
  if (goals == json->end() || !goals->is_array()) {
    return Fail(ErrorCode::kMalformed, "is no list", where + ": goals");
  }
  for (const Json& goal : *goals) record.goals.push_back(ReadGoalRecord(goal, where, error));
  if (error) return tl::unexpected(*error);
  return record;
}

std::string VisitResultsText(const VisitResults& results) {
  const VisitRun& run = results.run;
  const Json header = {{"format", kVisitFormat},         {"suite_hash", run.suite_hash},
                       {"memory_mode", run.memory_mode}, {"variant", run.variant},
                       {"config_hash", run.config_hash}, {"perception", run.perception},
                       {"version", run.version}};
  std::string text = header.dump() + "\n";
  for (const VisitRecord& record : results.records) text += VisitLine(record) + "\n";
  return text;
}

Result<VisitResults> ParseVisitResults(std::string_view text, const std::string& where) {
  VisitResults results;
  const std::string first(TakeLine(text));
  const auto header = ParseObject(first, where + ", line 1");
  if (!header) return tl::unexpected(header.error());
  if (auto ok = CheckFormat(*header, where + ", line 1"); !ok) return tl::unexpected(ok.error());
  const ResultLine line(*header, where + ", line 1");
  std::optional<Error> error;
  Take(line.Get<std::string>("suite_hash"), results.run.suite_hash, error);
  Take(line.Get<std::string>("memory_mode"), results.run.memory_mode, error);
  Take(line.Get<std::string>("variant"), results.run.variant, error);
  Take(line.Get<std::string>("config_hash"), results.run.config_hash, error);
  Take(line.Get<std::string>("perception"), results.run.perception, error);
  Take(line.Get<std::string>("version"), results.run.version, error);
  if (error) return tl::unexpected(*error);
  for (int number = 2; !text.empty(); ++number) {
    const std::string next(TakeLine(text));
    if (next.empty()) continue;
    auto record = ParseVisitLine(next, where + ", line " + std::to_string(number));
    if (!record) return tl::unexpected(record.error());
    results.records.push_back(std::move(*record));
  }
  return results;
}

}  // namespace crossnav::evaluation
