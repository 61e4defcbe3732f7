// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/records/result_extra.h"

#include <cmath>

namespace crossnav::evaluation {
namespace {

Json ToJson(const StageCause& cause) {
  Json json = {{"last_activity", cause.last_activity},
               {"under_way", cause.is_under_way},
               {"last_ending", cause.last_ending}};
  if (cause.flight) {
    json["flight"] = {{"floor", cause.flight->floor},
                      {"goal_floor", cause.flight->goal_floor},
                      {"seen", cause.flight->seen},
                      {"begun", cause.flight->begun},
                      {"climbed", cause.flight->climbed}};
  }
  json["seen_share"] = cause.seen_share;
  json["steps"] = Json::object();
  for (const auto& [activity, steps] : cause.steps) json["steps"][activity] = steps;
  return json;
}

Json ToJson(const StageWalk& walk) {
  Json json = {{"forward", walk.forward}, {"turn", walk.turn}, {"look", walk.look}};
  if (walk.reach) {
    json["reach"] = {{"walked_m", walk.reach->walked_m},
                     {"reach_shortest_m", walk.reach->reach_shortest_m},
                     {"end_shortest_m", walk.reach->end_shortest_m}};
  }
  return json;
}

FlightCause ReadFlight(const ResultLine& line, std::optional<Error>& error) {
  FlightCause flight;
  Take(line.Get<int>("floor"), flight.floor, error);
  Take(line.Get<int>("goal_floor"), flight.goal_floor, error);
  Take(line.Get<bool>("seen"), flight.seen, error);
  Take(line.Get<bool>("begun"), flight.begun, error);
  Take(line.Get<bool>("climbed"), flight.climbed, error);
  return flight;
}

/// `extra.cause`; absent in older files.
std::optional<StageCause> ReadCause(const ResultLine& extra, std::optional<Error>& error) {
  const auto found = extra.json().find("cause");
  if (found == extra.json().end() || found->is_null()) return std::nullopt;
  const ResultLine line(*found, extra.where() + ".cause");
  StageCause cause;
  Take(line.Get<std::string>("last_activity"), cause.last_activity, error);
  Take(line.Get<bool>("under_way"), cause.is_under_way, error);
  Take(line.Get<std::string>("last_ending"), cause.last_ending, error);
  Take(line.Get<double>("seen_share"), cause.seen_share, error);
  Take(line.Get<std::map<std::string, int>>("steps"), cause.steps, error);
  if (const auto flight = found->find("flight"); flight != found->end()) {
    cause.flight = ReadFlight(ResultLine(*flight, line.where() + ".flight"), error);
  }
  return cause;
}

/// A finite length that is not negative.
void TakeLength(const ResultLine& line, const char* key, double& target_m,
                std::optional<Error>& error) {
  Take(line.Get<double>(key), target_m, error);
  if (error || (std::isfinite(target_m) && target_m >= 0)) return;
  error = Error{ErrorCode::kInvalid, std::string("key \"") + key + "\" must be finite and >= 0",
                line.where()};
}

/// `extra.walk`; absent in older files.
std::optional<StageWalk> ReadWalk(const ResultLine& extra, std::optional<Error>& error) {
  const auto found = extra.json().find("walk");
  if (found == extra.json().end() || found->is_null()) return std::nullopt;
  const ResultLine line(*found, extra.where() + ".walk");
  StageWalk walk;
  Take(line.Get<int>("forward"), walk.forward, error);
  Take(line.Get<int>("turn"), walk.turn, error);
  Take(line.Get<int>("look"), walk.look, error);
  if (const auto reach = found->find("reach"); reach != found->end()) {
    const ResultLine inner(*reach, line.where() + ".reach");
    walk.reach.emplace();
    TakeLength(inner, "walked_m", walk.reach->walked_m, error);
    TakeLength(inner, "reach_shortest_m", walk.reach->reach_shortest_m, error);
    TakeLength(inner, "end_shortest_m", walk.reach->end_shortest_m, error);
  }
  return walk;
}

}  // namespace

Json ExtraJson(const StageExtra& extra) {
  Json json = {{"passed_target", extra.passed_target}, {"wrong_floor", extra.wrong_floor}};
  if (!extra.stairs.empty()) json["stairs"] = extra.stairs;
  if (extra.distance_to_goal_m) json["distance_to_goal_m"] = *extra.distance_to_goal_m;
  if (extra.cause) json["cause"] = ToJson(*extra.cause);
  if (extra.walk) json["walk"] = ToJson(*extra.walk);
  return json;
}

StageExtra ReadExtra(const ResultLine& line, std::optional<Error>& error) {
  StageExtra extra;
  double distance_m = -1;
  Take(line.GetOr<bool>("passed_target", false), extra.passed_target, error);
  Take(line.GetOr<bool>("wrong_floor", false), extra.wrong_floor, error);
  Take(line.GetOr<std::string>("stairs", ""), extra.stairs, error);
  Take(line.GetOr<double>("distance_to_goal_m", -1.0), distance_m, error);
  if (distance_m >= 0) extra.distance_to_goal_m = distance_m;
  extra.cause = ReadCause(line, error);
  extra.walk = ReadWalk(line, error);
  return extra;
}

}  // namespace crossnav::evaluation
