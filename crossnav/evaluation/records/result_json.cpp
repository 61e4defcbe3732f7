// SPDX-License-Identifier: MIT
// Result records <-> JSON; the only file of this room that uses the JSON library for them.
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "crossnav/core/read_file.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/evaluation/records/result_extra.h"
#include "crossnav/evaluation/records/result_line.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {
namespace {

Json ToJson(const Vector3d& p) {
  return Json::array({p.x(), p.y(), p.z()});
}

Json ToJson(const StageRecord& stage) {
  return {{"goal", stage.goal},
          {"outcome", NameOf(stage.outcome)},
          {"success", stage.success},
          {"start", ToJson(stage.start_world)},
          {"end", ToJson(stage.end_world)},
          {"shortest_m", stage.shortest_m},
          {"length_m", stage.length_m},
          {"actions", stage.actions},
          {"floor_start", stage.floor_start},
          {"floor_end", stage.floor_end},
          {"transitions", stage.transitions},
          {"extra", ExtraJson(stage.extra)}};
}

Vector3d ToVector(const std::vector<double>& values) {
  return values.size() == 3 ? Vector3d(values[0], values[1], values[2]) : Vector3d::Zero();
}

Result<StageRecord> ReadStage(const ResultLine& line) {
  StageRecord stage;
  std::optional<Error> error;
  std::string outcome;
  std::vector<double> start, end;
  Take(line.Get<std::string>("goal"), stage.goal, error);
  Take(line.Get<std::string>("outcome"), outcome, error);
  Take(line.Get<bool>("success"), stage.success, error);
  Take(line.Get<double>("shortest_m"), stage.shortest_m, error);
  Take(line.Get<double>("length_m"), stage.length_m, error);
  Take(line.GetOr<std::vector<double>>("start", {}), start, error);
  Take(line.GetOr<std::vector<double>>("end", {}), end, error);
  Take(line.GetOr<int>("actions", 0), stage.actions, error);
  Take(line.GetOr<int>("floor_start", 0), stage.floor_start, error);
  Take(line.GetOr<int>("floor_end", 0), stage.floor_end, error);
  Take(line.GetOr<int>("transitions", 0), stage.transitions, error);
  const Json extra_json = line.json().value("extra", Json::object());
  stage.extra = ReadExtra(ResultLine(extra_json, line.where() + ", extra"), error);
  if (error) return tl::unexpected(*error);
  const auto known = OutcomeFromName(outcome);
  if (!known) return Fail(ErrorCode::kInvalid, "unknown outcome \"" + outcome + "\"", line.where());
  stage.outcome = *known;
  stage.start_world = ToVector(start);
  stage.end_world = ToVector(end);
  return stage;
}

/// Preconditions of ComputeMetrics.
Result<void> CheckStages(const EpisodeRecord& episode, const std::string& where) {
  if (episode.goals.empty()) return Fail(ErrorCode::kInvalid, "key \"goals\" is empty", where);
  if (episode.actions < 0) return Fail(ErrorCode::kInvalid, "key \"actions\" is below 0", where);
  if (episode.first_transition_stage < 0 ||
      episode.first_transition_stage > static_cast<int>(episode.goals.size())) {
    return Fail(ErrorCode::kInvalid, "key \"first_transition_stage\" is no stage", where);
  }
  if (episode.failed && !episode.stages.empty()) {
    return Fail(ErrorCode::kInvalid, "a failed episode has no stages", where);
  }
  if (episode.stages.size() > episode.goals.size()) {
    return Fail(ErrorCode::kInvalid, "more stages than goals", where);
  }
  for (std::size_t k = 0; k < episode.stages.size(); ++k) {
    const StageRecord& stage = episode.stages[k];
    const std::string stage_where = where + ", stages[" + std::to_string(k) + "]";
    if (stage.goal != episode.goals[k]) {
      return Fail(ErrorCode::kInvalid, "goal is not the episode's goal " + episode.goals[k],
                  stage_where);
    }
    if (stage.success != (stage.outcome == Outcome::kSuccess)) {
      return Fail(ErrorCode::kInvalid, "success and outcome contradict each other", stage_where);
    }
    if (!std::isfinite(stage.shortest_m) || !std::isfinite(stage.length_m) ||
        stage.shortest_m < 0 || stage.length_m < 0) {
      return Fail(ErrorCode::kInvalid, "shortest_m and length_m must be finite and >= 0",
                  stage_where);
    }
    if (stage.actions < 0 || stage.transitions < 0)
      return Fail(ErrorCode::kInvalid, "actions and transitions must be >= 0", stage_where);
    if (!stage.success && k + 1 < episode.stages.size()) {
      return Fail(ErrorCode::kInvalid, "stages follow a failed one", stage_where);
    }
  }
  return {};
}

Result<EpisodeRecord> ReadEpisode(const ResultLine& line, int number) {
  EpisodeRecord episode;
  std::optional<Error> error;
  Take(line.GetOr<std::string>("episode_id", "line" + std::to_string(number)), episode.episode_id,
       error);
  Take(line.GetOr<std::string>("scene_id", ""), episode.scene_id, error);
  Take(line.GetOr<std::string>("track", ""), episode.track, error);
  Take(line.GetOr<bool>("cross_floor_required", false), episode.cross_floor_required, error);
  Take(line.GetOr<int>("first_transition_stage", 0), episode.first_transition_stage, error);
  Take(line.Get<std::vector<std::string>>("goals"), episode.goals, error);
  Take(line.GetOr<int>("actions", 0), episode.actions, error);
  Take(line.GetOr<double>("wall_s", 0.0), episode.wall_s, error);
  if (error) return tl::unexpected(*error);
  if (const auto failed = line.json().find("failed"); failed != line.json().end()) {
    if (!failed->is_object()) {
      return Fail(ErrorCode::kMalformed, "key \"failed\" is no object", line.where());
    }
    const ResultLine failure(*failed, line.where() + ", failed");
    episode.failed.emplace();
    Take(failure.Get<std::string>("reason"), episode.failed->reason, error);
    Take(failure.GetOr<std::string>("message", ""), episode.failed->message, error);
    if (error) return tl::unexpected(*error);
  }
  const auto stages = line.json().find("stages");
  if (stages == line.json().end() || !stages->is_array()) {
    return Fail(ErrorCode::kMalformed, "key \"stages\" is missing or no list", line.where());
  }
  for (std::size_t k = 0; k < stages->size(); ++k) {
    const ResultLine stage_line((*stages)[k], line.where() + ", stages[" + std::to_string(k) + "]");
    if (!stage_line.json().is_object()) {
      return Fail(ErrorCode::kMalformed, "is no object", stage_line.where());
    }
    auto stage = ReadStage(stage_line);
    if (!stage) return tl::unexpected(stage.error());
    episode.stages.push_back(std::move(*stage));
  }
  const Json timings = line.json().value("timing_ms", Json::object());
  for (const auto& [name, timing] : timings.items()) {
    if (!timing.is_object()) continue;
    episode.timing_ms[name] = {timing.value("p50", 0.0), timing.value("p95", 0.0)};
  }
  if (auto ok = CheckStages(episode, line.where()); !ok) return tl::unexpected(ok.error());
  return episode;
}

Result<RunHeader> ReadHeader(const ResultLine& line) {
  RunHeader header;
  std::optional<Error> error;
  int format = 0;
  Take(line.Get<int>("format"), format, error);
  Take(line.Get<std::string>("variant"), header.variant, error);
  Take(line.Get<std::string>("config_hash"), header.config_hash, error);
  Take(line.Get<std::string>("episodes_hash"), header.episodes_hash, error);
  Take(line.GetOr<int>("episodes", 0), header.episodes, error);
  Take(line.Get<std::uint64_t>("seed"), header.seed, error);
  Take(line.Get<std::string>("version"), header.version, error);
  Take(line.Get<std::string>("perception"), header.perception, error);
  Take(line.GetOr<std::string>("shard", "0/1"), header.shard, error);
  Take(line.GetOr<std::map<std::string, std::string>>("networks", {}), header.networks, error);
  if (error) return tl::unexpected(*error);
  if (format != 1) {
    return Fail(ErrorCode::kUnsupported, "format " + std::to_string(format) + ", this reads 1",
                line.where());
  }
  if (header.episodes < 0)
    return Fail(ErrorCode::kInvalid, "key \"episodes\" is below 0", line.where());
  if (auto shard = ParseShard(header.shard, line.where() + ": shard"); !shard)
    return tl::unexpected(shard.error());
  header.config_json = line.json().value("config", Json::object()).dump();
  const Json scenes = line.json().value("scenes", Json::object());
  for (const auto& [id, hashes] : scenes.items()) {
    header.scenes[id] = {hashes.value("mesh_hash", ""), hashes.value("navmesh_hash", "")};
  }
  return header;
}

/// Adds a whole line to `file`.
Result<void> ReadLine(const std::string& text, int number, const std::string& where,
                      ResultFile& file) {
  if (auto ok = CheckJsonShape(text, where); !ok) return ok;
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return Fail(ErrorCode::kMalformed, "is no JSON object", where);
  const ResultLine line(json, where);
  std::string kind = "episode";
  if (const auto it = json.find("kind"); it != json.end() && it->is_string()) kind = *it;
  if (kind == "header") {
    if (number != 1) return Fail(ErrorCode::kMalformed, "a second header", where);
    auto header = ReadHeader(line);
    if (!header) return tl::unexpected(header.error());
    file.header = std::move(*header);
    return {};
  }
  if (kind != "episode") return Fail(ErrorCode::kUnsupported, "unknown kind " + kind, where);
  auto episode = ReadEpisode(line, number);
  if (!episode) return tl::unexpected(episode.error());
  file.episodes.push_back(std::move(*episode));
  return {};
}

/// ReadLine, with the JSON library's type errors turned into Error.
Result<void> ReadLineSafely(const std::string& text, int number, const std::string& where,
                            ResultFile& file) {
  try {
    return ReadLine(text, number, where, file);
  } catch (const Json::exception&) {
    return Fail(ErrorCode::kMalformed, "a value has the wrong type", where);
  }
}

}  // namespace

std::string ToJsonLine(const RunHeader& header) {
  Json scenes = Json::object();
  for (const auto& [id, hashes] : header.scenes) {
    scenes[id] = {{"mesh_hash", hashes.mesh_hash}, {"navmesh_hash", hashes.navmesh_hash}};
  }
  Json json = {{"kind", "header"},
               {"format", 1},
               {"variant", header.variant},
               {"config", Json::parse(header.config_json.empty() ? "{}" : header.config_json)},
               {"config_hash", header.config_hash},
               {"episodes_hash", header.episodes_hash},
               {"episodes", header.episodes},
               {"scenes", std::move(scenes)},
               {"seed", header.seed},
               {"version", header.version},
               {"perception", header.perception},
               {"shard", header.shard}};
  if (!header.networks.empty()) json["networks"] = header.networks;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ToJsonLine(const EpisodeRecord& record, bool with_timings) {
  Json stages = Json::array();
  for (const StageRecord& stage : record.stages) stages.push_back(ToJson(stage));
  Json json = {{"kind", "episode"},
               {"episode_id", record.episode_id},
               {"scene_id", record.scene_id},
               {"cross_floor_required", record.cross_floor_required},
               {"first_transition_stage", record.first_transition_stage},
               {"goals", record.goals},
               {"actions", record.actions}};
  if (!record.track.empty()) json["track"] = record.track;
  if (with_timings) json["wall_s"] = record.wall_s;
  if (record.failed)
    json["failed"] = {{"reason", record.failed->reason}, {"message", record.failed->message}};
  json["stages"] = std::move(stages);
  if (with_timings) {
    Json timings = Json::object();
    for (const auto& [name, timing] : record.timing_ms) {
      timings[name] = {{"p50", timing.p50}, {"p95", timing.p95}};
    }
    json["timing_ms"] = std::move(timings);
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);  // messages may hold any bytes
}

Result<EpisodeRecord> EpisodeFromJsonLine(const std::string& text, const std::string& where) {
  ResultFile file;
  if (auto ok = ReadLineSafely(text, 2, where, file); !ok) return tl::unexpected(ok.error());
  if (file.episodes.empty()) return Fail(ErrorCode::kMalformed, "is no episode", where);
  return std::move(file.episodes.front());
}

Result<ResultFile> ReadResults(const std::filesystem::path& path) {
  const auto read = ReadFile(path);
  if (!read) return tl::unexpected(read.error());
  const std::string& text = *read;
  ResultFile file;
  std::set<std::string> ids;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) {
      file.has_torn_line = true;
      break;
    }
    ++number;
    const std::string where = path.string() + ": line " + std::to_string(number);
    if (end > begin) {
      auto ok = ReadLineSafely(text.substr(begin, end - begin), number, where, file);
      if (!ok) return tl::unexpected(ok.error());
    }
    if (!file.episodes.empty() && ids.size() < file.episodes.size() &&
        !ids.insert(file.episodes.back().episode_id).second) {
      return Fail(ErrorCode::kInvalid, "duplicate episode " + file.episodes.back().episode_id,
                  where);
    }
    begin = end + 1;
    file.valid_bytes = begin;
  }
  SortRecords(file.episodes);
  return file;
}

}  // namespace crossnav::evaluation
