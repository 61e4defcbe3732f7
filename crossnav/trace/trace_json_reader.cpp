// SPDX-License-Identifier: MIT
#include <array>

#include "crossnav/trace/json_reader.h"
#include "crossnav/trace/trace_json.h"

namespace crossnav::trace {
namespace {

using Element = JsonReader::Element;

void ReadCandidate(JsonReader& in, const Element& e, CandidateTrace& c) {
  in.Field(e, "kind", c.kind);
  in.Field(e, "p_nav_world", c.p_nav_world);
  in.Field(e, "p_focus_world", c.p_focus_world);
  in.Field(e, "score", c.score);
  in.Field(e, "path_cost", c.path_cost);
  in.Field(e, "size", c.size);
  in.Field(e, "is_reachable", c.is_reachable);
  in.Field(e, "is_target", c.is_target);
}

void ReadVerification(JsonReader in, const Element& e, VerificationTrace& v) {
  in.Field(e, "is_active", v.is_active);
  in.Field(e, "passed", v.passed);
  in.Field(e, "confidence", v.confidence);
  in.Field(e, "mask_quality", v.mask_quality);
  in.Field(e, "visibility", v.visibility);
  in.Field(e, "view_angle_deg", v.view_angle_deg);
  in.Field(e, "distance_m", v.distance_m);
  in.Field(e, "failed_check", v.failed_check);
}

void ReadAgent(JsonReader in, const Element& e, AgentPose& agent) {
  in.Field(e, "p_world", agent.p_world);
  in.Field(e, "yaw_rad", agent.yaw_rad);
  in.Field(e, "pitch_rad", agent.pitch_rad);
}

void ReadPose(JsonReader in, const Element& e, Pose& T) {
  std::array<double, 12> rows{};
  in.Numbers(e, rows.data(), rows.size());
  for (int i = 0; i < 12; ++i) T.matrix()(i / 4, i % 4) = rows[static_cast<std::size_t>(i)];
}

void ReadAction(JsonReader in, const Element& e, Action& action) {
  std::string name;
  in.Read(e, name);
  for (const Action a : {Action::kMoveForward, Action::kTurnLeft, Action::kTurnRight,
                         Action::kLookUp, Action::kLookDown, Action::kStop}) {
    if (NameOf(a) == name) {
      action = a;
      return;
    }
  }
  in.Complain("", "no such action: " + name);
}

void ReadPoint(JsonReader& in, const Element& e, Vector3d& p) {
  in.Read(e, p);
}

void ReadTry(JsonReader& in, const Element& e, geometry::FlightTry& attempt) {
  in.Field(e, "p_from_world", attempt.p_from_world);
  in.Field(e, "is_up", attempt.is_up);
  std::string name;
  in.Field(e, "ending", name);
  for (int i = 0; i < geometry::kTryEndings; ++i) {
    attempt.ending = static_cast<geometry::TryEnding>(i);
    if (NameOf(attempt.ending) == name) return;
  }
  in.Complain("ending", "no such ending: " + name);
}

void ReadFlight(JsonReader& in, const Element& e, geometry::StairFlight& flight) {
  in.Field(e, "id", flight.id);
  in.Field(e, "p_foot_world", flight.p_foot_world);
  in.Field(e, "p_top_world", flight.p_top_world);
  in.ListField(e, "steps_world", flight.steps_world, ReadPoint);
  in.Field(e, "confidence", flight.confidence);
  in.Field(e, "walked_up", flight.walked_up);
  in.Field(e, "walked_down", flight.walked_down);
  in.ListField(e, "seen_from_world", flight.seen_from_world, ReadPoint);
  in.ListField(e, "tries", flight.tries, ReadTry);
}

void ReadChange(JsonReader& in, const Element& e, geometry::StateChange& change) {
  std::array<double, 5> n{};
  in.Numbers(e, n.data(), n.size());
  if (!in.ok()) return;
  for (const double value : n) {
    if (!(std::abs(value) < 2147483648.0) || value != std::floor(value)) {
      return in.Complain("", "expected whole numbers x, y, z, state, inflated");
    }
  }
  if (n[3] < 0 || n[3] >= geometry::kVoxelStateCount || n[4] < 0 || n[4] > 1) {
    return in.Complain("", "no such voxel state");
  }
  change.key = {static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<int>(n[2])};
  change.voxel.state = static_cast<geometry::VoxelState>(n[3]);
  change.voxel.is_inflated = n[4] == 1;
}

void ReadStep(JsonReader& in, const Element& e, StepTrace& step) {
  in.Field(e, "step", step.step);
  in.Field(e, "goal_index", step.goal_index);
  in.Field(e, "goal", step.goal);
  if (const auto agent = in.Find(e, "agent")) ReadAgent(in.Below("agent"), *agent, step.agent);
  if (const auto pose = in.Find(e, "T_world_camera")) {
    ReadPose(in.Below("T_world_camera"), *pose, step.T_world_camera);
  }
  if (const auto action = in.Find(e, "action")) {
    ReadAction(in.Below("action"), *action, step.action);
  }
  in.Field(e, "mode", step.mode);
  in.Field(e, "reason", step.reason);
  // Absent in records older than the activities.
  if (e["activity"].error() == simdjson::SUCCESS) in.Field(e, "activity", step.activity);
  in.ListField(e, "candidates", step.candidates, ReadCandidate);
  in.ListField(e, "path_world", step.path_world, ReadPoint);
  if (const auto v = in.Find(e, "verification")) {
    ReadVerification(in.Below("verification"), *v, step.verification);
  }
  if (e["flights"].error() == simdjson::SUCCESS)
    in.ListField(e, "flights", step.flights.emplace(), ReadFlight);
  in.ListField(e, "events", step.events,
               [](JsonReader& r, const Element& item, std::string& text) { r.Read(item, text); });
  in.Field(e, "level_m", step.level_m);
  in.Field(e, "all_explored", step.all_explored);
  in.Field(e, "detections", step.detections);
  // Absent in records older than the memory's counters.
  if (e["memory"].error() == simdjson::SUCCESS) {
    const Element memory = *in.Find(e, "memory");
    JsonReader below = in.Below("memory");
    below.Field(memory, "rows", step.memory.rows);
    below.Field(memory, "compacted_rows", step.memory.compacted_rows);
    below.Field(memory, "dropped_rows", step.memory.dropped_rows);
  }
  if (e["voxel_changes"].error() == simdjson::SUCCESS) {
    in.ListField(e, "voxel_changes", step.voxel_changes, ReadChange);
  }
}

}  // namespace

Result<StepTrace> StepTraceFromJson(std::string_view json) {
  return ParseJson<StepTrace>(json, "step record", ReadStep);
}

}  // namespace crossnav::trace
