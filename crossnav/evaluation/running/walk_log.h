// SPDX-License-Identifier: MIT
// Follows the robot through a stage, for StageWalk. World frame, metres.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"

namespace crossnav::evaluation {

class WalkLog {
 public:
  /// After an action: where the robot is, and how far the action moved it.
  void Add(Action action, const Vector3d& p_world, double moved_m);

  /// `stage` has ended, with its outcome, start and end known.
  StageWalk Finish(const SceneContext& context, const StageRecord& stage,
                   const EvalConfig& eval) const;

 private:
  struct Place {
    Vector3d p_world;
    double walked_m;
  };
  std::optional<StageReach> Reach(const SceneContext& context, const StageRecord& stage,
                                  const EvalConfig& eval) const;

  StageWalk walk_;
  std::vector<Place> places_;  // after each action that moved
  double walked_m_ = 0;
};

}  // namespace crossnav::evaluation
