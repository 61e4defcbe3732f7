// SPDX-License-Identifier: MIT
// Records the robot's path through a stage, for StageWalk. World frame, metres.
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
  /// Adds the place after an action, and the distance that it moved.
  void Add(Action action, const Vector3d& p_world, double moved_m);

  /// `stage` has ended; its outcome, start and end are set.
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
