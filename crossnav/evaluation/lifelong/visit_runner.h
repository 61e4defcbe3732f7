// SPDX-License-Identifier: MIT
// Plays one visit: its goals in order, each with its own budget, each from the end of the previous
// search, successful or not. World frame, metres.
#pragma once

#include <functional>
#include <vector>

#include "crossnav/agent/agent.h"
#include "crossnav/evaluation/lifelong/visits.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::evaluation {

/// Counts departures for stale places during the search for one goal: places where the goal stood
/// on an earlier day only.
class StaleWatch {
 public:
  explicit StaleWatch(std::vector<Vector3d> stale_world) : stale_world_(std::move(stale_world)) {}

  void Add(const trace::StepTrace& step);
  int visits() const { return visits_; }
  int revised_after() const { return revised_after_; }

 private:
  std::vector<Vector3d> stale_world_;
  int steps_ = 0, visits_ = 0, revised_after_ = 0;
  int last_ = -1;  // stale place of the previous step; -1 = none
};

/// Memory at the start and the end of a visit, and an observer of its steps and goals.
struct VisitHooks {
  std::function<Result<void>(agent::Agent&)> begin = [](agent::Agent&) { return Result<void>(); };
  std::function<Result<void>(const agent::Agent&)> end = [](const agent::Agent&) {
    return Result<void>();
  };
  RunObserver* observer = nullptr;  ///< OnStep and OnStageEnd
};

/// Errors: a start off the navmesh, an unreachable goal, a malformed observation, a failing hook.
Result<VisitRecord> PlayVisit(const SceneContext& context, const HouseVisit& visit,
                              const RunConfig& config, const VisitHooks& hooks,
                              const MakePerception& make_perception = {});

}  // namespace crossnav::evaluation
