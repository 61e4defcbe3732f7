// SPDX-License-Identifier: MIT
#include "crossnav/agent/last_resort.h"

#include "crossnav/agent/remembered_places.h"
#include "crossnav/agent/scan.h"

namespace crossnav::agent {

bool TryLastResort(StepState& now) {
  GoalState& goal = now.goal;
  for (HistoryPoi& poi : goal.history) poi.unreachable_step.reset();
  while (goal.full.last_resorts < 4) {
    switch (goal.full.last_resorts++) {
      case 0:
        if ((goal.p_looked_around_world - now.agent.p_world).norm() < 0.5) continue;
        LookAround(now);
        goal.events.push_back("nothing left: looking around");
        return true;
      case 1:
        if (!now.world.ground.HasBlocked()) continue;
        now.world.ground.ForgetBlocked();
        goal.events.push_back("nothing left: bumps forgotten");
        return true;
      case 2: {
        Config relaxed = now.config;
        relaxed.query.min_similarity *= 0.8;  // chosen: looser, still a response
        relaxed.query.min_z_score *= 0.6;
        goal.history = RememberedPlaces(now.world, goal, relaxed);
        if (goal.history.empty()) continue;
        goal.events.push_back("nothing left: asking the memory again");
        return true;
      }
      default:
        goal.full.attempts.clear();
        goal.live.ForgiveDiscarded();
        goal.tried_viewpoints.clear();
        goal.failed_views = 0;
        now.world.coverage.Clear();
        goal.full.inspect_range_m *= 0.6;  // chosen: near enough for the smallest category
        now.world.ground.ForgetBlocked();
        goal.events.push_back("nothing left: trying once more with relaxed limits");
        return true;
    }
  }
  return false;
}

}  // namespace crossnav::agent
