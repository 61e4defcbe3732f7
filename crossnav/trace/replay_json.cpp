// SPDX-License-Identifier: MIT
#include "crossnav/trace/replay_json.h"

#include "crossnav/trace/json_reader.h"
#include "crossnav/trace/json_text.h"

namespace crossnav::trace {
namespace {

using Element = JsonReader::Element;

void ReadInstance(JsonReader& in, const Element& e, GoalInstance& instance) {
  in.Field(e, "goal", instance.goal);
  in.Field(e, "box_min", instance.box.min);
  in.Field(e, "box_max", instance.box.max);
}

void ReadInfo(JsonReader& in, const Element& e, ReplayInfo& info) {
  int format = 0;
  in.Field(e, "format", format);
  if (in.ok() && format != kReplayFormat) {
    return in.Complain(
        "format", "replays of format " + std::to_string(format) + " are not known to this program");
  }
  in.Field(e, "scene_id", info.scene_id);
  in.Field(e, "episode_id", info.episode_id);
  in.ListField(e, "goals", info.goals,
               [](JsonReader& r, const Element& item, std::string& goal) { r.Read(item, goal); });
  in.Field(e, "variant", info.variant);
  in.Field(e, "perception", info.perception);
  in.Field(e, "version", info.version);
  in.Field(e, "config_hash", info.config_hash);
  in.Field(e, "seed", info.seed);
  in.Field(e, "voxel_m", info.voxel_m);
  in.ListField(e, "goal_instances", info.goal_instances, ReadInstance);
}

void ReadStage(JsonReader& in, const Element& e, StageResult& stage) {
  in.Field(e, "goal_index", stage.goal_index);
  in.Field(e, "goal", stage.goal);
  in.Field(e, "outcome", stage.outcome);
  in.Field(e, "success", stage.success);
  in.Field(e, "last_step", stage.last_step);
  in.Field(e, "length_m", stage.length_m);
  in.Field(e, "shortest_m", stage.shortest_m);
}

}  // namespace

std::string ToJson(const ReplayInfo& info) {
  JsonText json;
  json.BeginObject()
      .Field("format", kReplayFormat)
      .Field("scene_id", std::string_view(info.scene_id))
      .Field("episode_id", std::string_view(info.episode_id))
      .Key("goals")
      .BeginArray();
  for (const std::string& goal : info.goals) json.Value(std::string_view(goal));
  json.EndArray()
      .Field("variant", std::string_view(info.variant))
      .Field("perception", std::string_view(info.perception))
      .Field("version", std::string_view(info.version))
      .Field("config_hash", std::string_view(info.config_hash))
      .Field("seed", info.seed)
      .Field("voxel_m", info.voxel_m)
      .Key("goal_instances")
      .BeginArray();
  for (const GoalInstance& instance : info.goal_instances) {
    json.BeginObject()
        .Field("goal", std::string_view(instance.goal))
        .Field("box_min", instance.box.min)
        .Field("box_max", instance.box.max)
        .EndObject();
  }
  json.EndArray().EndObject();
  return json.Take();
}

std::string ToJson(const StageResult& stage) {
  JsonText json;
  json.BeginObject()
      .Field("goal_index", stage.goal_index)
      .Field("goal", std::string_view(stage.goal))
      .Field("outcome", std::string_view(stage.outcome))
      .Field("success", stage.success)
      .Field("last_step", stage.last_step)
      .Field("length_m", stage.length_m)
      .Field("shortest_m", stage.shortest_m)
      .EndObject();
  return json.Take();
}

Result<ReplayInfo> ReplayInfoFromJson(std::string_view json) {
  return ParseJson<ReplayInfo>(json, "replay head", ReadInfo);
}

Result<StageResult> StageResultFromJson(std::string_view json) {
  return ParseJson<StageResult>(json, "stage result", ReadStage);
}

}  // namespace crossnav::trace
