// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/walk_log.h"

#include "crossnav/evaluation/scoring/outcome.h"

namespace crossnav::evaluation {
namespace {

/// The instance of a STOP at `p_world`: the nearest instance for which it is a success.
const Target* StoppedAt(const SceneContext& context, const std::string& goal,
                        const Vector3d& p_world, const EvalConfig& eval) {
  const int floor = context.navmesh().FloorOf(p_world);
  const Target* nearest = nullptr;
  for (const Target& target : context.TargetsOf(goal)) {
    if (!IsWithinBoxRadius(target, p_world, floor, eval)) continue;
    if (nearest == nullptr ||
        target.box.HorizontalDistance(p_world) < nearest->box.HorizontalDistance(p_world))
      nearest = &target;
  }
  return nearest;
}

}  // namespace

void WalkLog::Add(Action action, const Vector3d& p_world, double moved_m) {
  if (action == Action::kMoveForward) ++walk_.forward;
  if (action == Action::kTurnLeft || action == Action::kTurnRight) ++walk_.turn;
  if (action == Action::kLookUp || action == Action::kLookDown) ++walk_.look;
  walked_m_ += moved_m;
  if (moved_m > 0) places_.push_back({p_world, walked_m_});
}

std::optional<StageReach> WalkLog::Reach(const SceneContext& context, const StageRecord& stage,
                                         const EvalConfig& eval) const {
  const Target* target = StoppedAt(context, stage.goal, stage.end_world, eval);
  if (target == nullptr) return std::nullopt;  // eval.success = viewpoint
  Place reach{stage.end_world, walked_m_};
  for (std::size_t i = places_.size() + 1; i-- > 0;) {
    const Place place = i > 0 ? places_[i - 1] : Place{stage.start_world, 0};
    const int floor = context.navmesh().FloorOf(place.p_world);
    if (!IsWithinBoxRadius(*target, place.p_world, floor, eval)) break;
    reach = place;
  }
  const auto to_reach_m = context.navmesh().Geodesic(stage.start_world, reach.p_world);
  const auto to_end_m = context.navmesh().Geodesic(stage.start_world, stage.end_world);
  if (!to_reach_m || !to_end_m) return std::nullopt;  // on a sliver of the navmesh
  return StageReach{reach.walked_m, *to_reach_m, *to_end_m};
}

StageWalk WalkLog::Finish(const SceneContext& context, const StageRecord& stage,
                          const EvalConfig& eval) const {
  StageWalk walk = walk_;
  if (stage.success) walk.reach = Reach(context, stage, eval);
  return walk;
}

}  // namespace crossnav::evaluation
