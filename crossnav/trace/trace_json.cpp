// SPDX-License-Identifier: MIT
#include "crossnav/trace/trace_json.h"

#include "crossnav/trace/json_text.h"

namespace crossnav::trace {
namespace {

void Append(JsonText& json, const CandidateTrace& c) {
  json.BeginObject()
      .Field("kind", std::string_view(c.kind))
      .Field("p_nav_world", c.p_nav_world)
      .Field("p_focus_world", c.p_focus_world)
      .Field("score", c.score)
      .Field("path_cost", c.path_cost)
      .Field("size", c.size)
      .Field("is_reachable", c.is_reachable)
      .Field("is_target", c.is_target)
      .EndObject();
}

void Append(JsonText& json, const VerificationTrace& v) {
  json.BeginObject()
      .Field("is_active", v.is_active)
      .Field("passed", v.passed)
      .Field("confidence", v.confidence)
      .Field("mask_quality", v.mask_quality)
      .Field("visibility", v.visibility)
      .Field("view_angle_deg", v.view_angle_deg)
      .Field("distance_m", v.distance_m)
      .Field("failed_check", std::string_view(v.failed_check))
      .EndObject();
}

void Append(JsonText& json, const MemoryTrace& m) {
  json.BeginObject()
      .Field("rows", m.rows)
      .Field("compacted_rows", m.compacted_rows)
      .Field("dropped_rows", m.dropped_rows)
      .EndObject();
}

void Append(JsonText& json, const AgentPose& agent) {
  json.BeginObject()
      .Field("p_world", agent.p_world)
      .Field("yaw_rad", agent.yaw_rad)
      .Field("pitch_rad", agent.pitch_rad)
      .EndObject();
}

void Append(JsonText& json, const Pose& T) {
  json.BeginArray();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) json.Value(T.matrix()(row, column));
  }
  json.EndArray();
}

void Append(JsonText& json, const geometry::StateChange& change) {
  json.BeginArray().Value(change.key.x).Value(change.key.y).Value(change.key.z);
  json.Value(static_cast<int>(change.voxel.state)).Value(change.voxel.is_inflated ? 1 : 0);
  json.EndArray();
}

void Append(JsonText& json, const Vector3d& v) {
  json.Value(v);
}
void Append(JsonText& json, const std::string& text) {
  json.Value(std::string_view(text));
}

template <class T>
void AppendAll(JsonText& json, std::string_view key, const std::vector<T>& values);

void Append(JsonText& json, const geometry::FlightTry& t) {
  json.BeginObject()
      .Field("p_from_world", t.p_from_world)
      .Field("is_up", t.is_up)
      .Field("ending", NameOf(t.ending))
      .EndObject();
}

void Append(JsonText& json, const geometry::StairFlight& f) {
  json.BeginObject().Field("id", f.id).Field("p_foot_world", f.p_foot_world);
  json.Field("p_top_world", f.p_top_world).Field("direction_up", f.DirectionUp());
  AppendAll(json, "steps_world", f.steps_world);
  json.Field("confidence", f.confidence)
      .Field("walked_up", f.walked_up)
      .Field("walked_down", f.walked_down);
  AppendAll(json, "seen_from_world", f.seen_from_world);
  AppendAll(json, "tries", f.tries);
  json.EndObject();
}

template <class T>
void AppendAll(JsonText& json, std::string_view key, const std::vector<T>& values) {
  json.Key(key).BeginArray();
  for (const T& value : values) Append(json, value);
  json.EndArray();
}

}  // namespace

std::string ToJson(const StepTrace& step, VoxelText voxels) {
  JsonText json;
  json.BeginObject()
      .Field("step", step.step)
      .Field("goal_index", step.goal_index)
      .Field("goal", std::string_view(step.goal));
  Append(json.Key("agent"), step.agent);
  Append(json.Key("T_world_camera"), step.T_world_camera);
  json.Field("action", NameOf(step.action))
      .Field("mode", std::string_view(step.mode))
      .Field("reason", std::string_view(step.reason))
      .Field("activity", std::string_view(step.activity));
  AppendAll(json, "candidates", step.candidates);
  AppendAll(json, "path_world", step.path_world);
  Append(json.Key("verification"), step.verification);
  if (step.flights) AppendAll(json, "flights", *step.flights);
  AppendAll(json, "events", step.events);
  json.Field("level_m", step.level_m)
      .Field("all_explored", step.all_explored)
      .Field("detections", step.detections);
  Append(json.Key("memory"), step.memory);
  if (voxels == VoxelText::kInclude) AppendAll(json, "voxel_changes", step.voxel_changes);
  json.EndObject();
  return json.Take();
}

}  // namespace crossnav::trace
