// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/outcome.h"

#include <algorithm>

namespace crossnav::evaluation {
bool IsWithinBoxRadius(const Target& target, const Vector3d& p_world, int floor,
                       const EvalConfig& eval) {
  return target.box.HorizontalDistance(p_world) <= eval.success_radius_m &&
         Holds(target.floors, floor);
}

bool IsGoalReached(const SceneContext& context, const std::vector<Target>& targets,
                   const Vector3d& p_world, const EvalConfig& eval) {
  const int floor = context.navmesh().FloorOf(p_world);
  return std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
    if (eval.success == "box") return IsWithinBoxRadius(target, p_world, floor, eval);
    const auto distance_m = context.navmesh().Geodesic(p_world, target.viewpoints_world);
    return distance_m && *distance_m <= eval.viewpoint_radius_m;
  });
}

bool IsOnWrongFloor(const std::vector<Target>& targets, const Vector3d& p_world, int floor,
                    const EvalConfig& eval) {
  bool is_wrong = false;
  for (const Target& target : targets) {
    if (target.floors.empty()) continue;
    if (target.box.HorizontalDistance(p_world) > eval.success_radius_m) continue;
    if (Holds(target.floors, floor)) return false;
    is_wrong = true;
  }
  return is_wrong;
}

Outcome JudgeStage(const StageEnd& end, const EvalConfig& eval) {
  if (end.stopped) {
    if (end.is_reached) return Outcome::kSuccess;
    return end.is_claim_near ? Outcome::kNotReached : Outcome::kMisdetection;
  }
  if (end.all_explored) return Outcome::kAllExplored;
  return end.recent_path_m < eval.stuck_m ? Outcome::kStuck : Outcome::kOutOfTime;
}

void StairWatch::Add(const trace::StepTrace& step) {
  has_session_ = has_session_ || step.mode == "stair_explore";
  for (const std::string& event : step.events) {
    has_session_ = has_session_ || event == "stairs up verified" || event == "stairs down verified";
    has_rejection_ = has_rejection_ || event == "entrance rejected";
    has_landing_ = has_landing_ || event.starts_with("new level") || event == "on another level";
  }
}

std::string StairWatch::Verdict(int transitions) const {
  if (transitions > 0) return has_landing_ ? "" : "landing_not_confirmed";
  if (has_session_) return "lost_on_flight";
  if (has_rejection_) return "entrance_rejected";
  return "never_found";
}

}  // namespace crossnav::evaluation
