// SPDX-License-Identifier: MIT
#include "crossnav/agent/choose.h"

#include <utility>

#include "crossnav/agent/closed_way.h"
#include "crossnav/agent/explore.h"
#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/scan.h"

namespace crossnav::agent {

using geometry::VoxelKey;

namespace {

template <class P>
P PursuitTo(GroundTarget target) {
  P pursuit;
  pursuit.target = std::move(target.candidate);
  pursuit.route.path = std::move(target.path);
  return pursuit;
}

Choice TakeLivePoi(GroundTarget live) {
  Choice choice;
  choice.shown.push_back(live.candidate);
  auto approach = PursuitTo<Approach>(std::move(live));
  approach.poi_id = *approach.target.poi_id;
  choice.next = Take{std::move(approach)};
  return choice;
}

void TakePlace(PlaceChoice place, Choice* choice) {
  choice->shown.push_back(place.target->candidate);
  auto visit = PursuitTo<VisitPlace>(std::move(*place.target));
  visit.place = place.place;
  choice->next = Take{std::move(visit)};
}

void TakeExploration(const Situation& now, GroundTarget target, Choice* choice) {
  const Vector3d p_end = CenterOf(target.path.back(), now.config.map.voxel_m);
  if (IsOverStairs(now, p_end))
    choice->next = Take{PursuitTo<Climb>(std::move(target))};
  else
    choice->next = Take{PursuitTo<GoTo>(std::move(target))};
}

/// Exploration continues while the target is open and its path holds, and is reconsidered after
/// the grace period. A door on the way to a remembered place is looked at before anything else.
void Explore(const Situation& now, const VoxelKey& start, Choice* choice) {
  const Pursuit& pursuit = PursuitOf(now.goal.full.activity);
  const bool is_exploring = IsExploring(pursuit);
  if (is_exploring) {
    const Pursued& pursued = *PursuedIn(pursuit);
    if (!IsStillOpen(now, pursued.target)) {
      choice->next = Drop{Ending::kGone};
      return;
    }
    choice->findings.path = CheckPath(now);
    const bool is_due = pursued.route.steps % now.config.policy.explore.reconsider_steps == 0;
    if (choice->findings.path->IsOpen() && !is_due) return;
  }
  if (auto way = ChooseClosedWay(now, start, choice->findings.unreachable_steps)) {
    choice->shown.push_back(way->candidate);
    TakeExploration(now, std::move(*way), choice);
    return;
  }
  ExplorationChoice exploration = ChooseExploration(now, start);
  choice->shown = std::move(exploration.shown);
  choice->findings.has_found_descent = exploration.has_found_descent;
  choice->findings.relevancy = std::move(exploration.relevancy);
  if (!exploration.target) {
    if (is_exploring) choice->next = Drop{Ending::kUnreachable};
    return;
  }
  TakeExploration(now, std::move(*exploration.target), choice);
}

void Remember(StepState& now, const Findings& findings) {
  if (findings.path) UpdatePath(now, *findings.path);
  for (std::size_t i = 0; i < findings.unreachable_steps.size(); ++i)
    now.goal.history[i].unreachable_step = findings.unreachable_steps[i];
  if (findings.has_found_descent) now.world.full.levels_with_descent_m.push_back(now.world.level_m);
  if (findings.relevancy) {
    now.goal.full.relevancy = *findings.relevancy;
    now.goal.full.relevancy_step = now.world.step;
  }
}

/// A live POI interrupts scans and visits.
void PrepareApproach(StepState& now, int poi_id) {
  GoalState& goal = now.goal;
  if (poi_id != goal.active_live) {
    // Two live POIs may take turns: each keeps the views that failed.
    std::vector<FailedViews>& failed = goal.full.failed;
    failed.push_back(
        {goal.active_live, goal.tried_viewpoints, goal.failed_views, goal.full.doubtful_m});
    const FailedViews own = FailedViewsOf(goal, poi_id);
    std::erase_if(failed, [&](const FailedViews& views) { return views.poi_id == poi_id; });
    goal.tried_viewpoints = own.p_from_world;
    goal.failed_views = own.count;
    goal.full.doubtful_m = own.doubtful_m;
  }
  if (const VisitPlace* visit = std::get_if<VisitPlace>(&PursuitOf(goal.full.activity))) {
    const HistoryPoi& poi = goal.history[static_cast<std::size_t>(visit->place)];
    goal.events.push_back("history POI led to the goal, similarity " +
                          std::to_string(poi.similarity) + " score " + std::to_string(poi.score));
  }
  goal.active_live = poi_id;
  EndScan(now);
}

/// memory.mode = revise: the place was seen to be empty on the way to it.
bool IsSettledFromAfar(const Situation& now, const VisitPlace& visit) {
  return now.world.revision && now.goal.history[static_cast<std::size_t>(visit.place)].is_exhausted;
}

void CarryOut(StepState& /*now*/, Keep /*keep*/) {}
void CarryOut(StepState& now, Drop drop) {
  End(now, drop.ending);
}
void CarryOut(StepState& now, Take take) {
  if (const Approach* approach = std::get_if<Approach>(&take.pursuit))
    PrepareApproach(now, approach->poi_id);
  Begin(now, std::move(take.pursuit));
}
void CarryOut(StepState& now, Glance glance) {
  if (Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity)))
    pursued->route.motion.clear();
  BeginScan(now, std::move(glance.turns));
  now.goal.events.push_back("a glance at unseen ground");
}

}  // namespace

// Precedence: live POI, scan in progress, visit in progress, remembered place, glance, door that
// was shut on the way to a remembered place, exploration.
Choice Choose(const Situation& now) {
  Choice choice;
  const Activity& activity = now.goal.full.activity;
  const Pursuit& pursuit = PursuitOf(activity);
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  if (!start) {
    if (PursuedIn(pursuit)) choice.next = Drop{Ending::kUnreachable};
    return choice;
  }
  if (auto live = ChooseLivePoi(now, *start)) return TakeLivePoi(std::move(*live));
  if (std::holds_alternative<Approach>(pursuit)) {
    choice.next = Drop{Ending::kUnreachable};
    return choice;
  }
  if (IsScanning(activity)) return choice;
  const bool is_visiting = std::holds_alternative<VisitPlace>(pursuit);
  if (is_visiting && IsSettledFromAfar(now, std::get<VisitPlace>(pursuit))) {
    choice.next = Drop{Ending::kGone};
    return choice;
  }
  if (is_visiting) {
    choice.findings.path = CheckPath(now);
    if (choice.findings.path->IsOpen()) return choice;
  }
  PlaceChoice place = ChooseHistoryPoi(now, *start);
  choice.findings.unreachable_steps = std::move(place.unreachable_steps);
  if (place.target) {
    TakePlace(std::move(place), &choice);
    return choice;
  }
  if (is_visiting) {
    choice.next = Drop{Ending::kUnreachable};
    return choice;
  }
  if (IsOnLevel(now, now.agent.p_world)) {
    if (auto turns = GlanceFrom(now, *start); !turns.empty()) {
      choice.next = Glance{std::move(turns)};
      return choice;
    }
  }
  Explore(now, *start, &choice);
  return choice;
}

void Apply(StepState& now, Choice choice) {
  Remember(now, choice.findings);
  std::visit([&](auto& next) { CarryOut(now, std::move(next)); }, choice.next);
}

}  // namespace crossnav::agent
