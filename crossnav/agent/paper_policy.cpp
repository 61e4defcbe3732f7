// SPDX-License-Identifier: MIT
#include "crossnav/agent/paper_policy.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "crossnav/agent/paper_behaviour.h"
#include "crossnav/agent/paper_targets.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/policy/stair_geometry.h"
#include "crossnav/policy/takeover.h"

namespace crossnav::agent::paper {

using policy::Mode;
using policy::ModeDecision;
using policy::ModeInputs;

namespace {

constexpr double kOtherLevel_m = 0.5;  // chosen: more than the level band

/// Candidates of this step, each with its plan.
struct Options {
  std::optional<Target> live, history, exploration, stair;
  int live_id = -1, history_index = -1;
  std::vector<policy::Candidate> shown;
};

/// eq:supp_candidate_set. Only classes that could be chosen now are planned for.
Options CollectCandidates(Situation& now) {
  Options options;
  if (now.goal.paper.session) {
    if (now.goal.paper.script.empty()) options.stair = ChooseStairFrontier(now);
    if (options.stair) options.shown.push_back(options.stair->candidate);
    return options;
  }
  options.live = ChooseLivePoi(now, &options.live_id);
  options.history = ChooseHistoryPoi(now, &options.history_index);
  if (!options.live && !options.history && !now.goal.paper.entrance &&
      now.goal.paper.script.empty())
    options.exploration = ChooseExploration(now, &options.shown);
  if (options.history) options.shown.insert(options.shown.begin(), options.history->candidate);
  if (options.live) options.shown.insert(options.shown.begin(), options.live->candidate);
  return options;
}

ModeInputs InputsFor(const Situation& now, const Options& options, SessionVerdict session,
                     EntranceVerdict entrance) {
  ModeInputs in;
  in.mode = now.goal.paper.mode;
  in.is_new_goal = now.goal.paper.is_new;
  in.entrance_verified = entrance == EntranceVerdict::kVerified;
  in.session_on_landing = session == SessionVerdict::kLandingReached;
  in.session_failed = session == SessionVerdict::kFailed;
  in.has_live_poi = options.live.has_value();
  in.has_history_poi = options.history.has_value();
  in.is_following_history = now.goal.paper.active_history >= 0;
  in.verification_failed = now.goal.paper.is_detection_rejected;
  if (options.live && options.history) {
    in.live_near_history =
        policy::IsTakeover(options.live->candidate.p_focus_world,
                           options.history->candidate.p_focus_world, now.config.policy.poi);
  }
  in.is_near_viewpoint =
      options.live && options.live->plan.cost * now.config.map.voxel_m <= 1.0;  // chosen
  return in;
}

void UpdateLevel(Situation& now) {
  World& world = now.world;
  GoalState& goal = now.goal;
  if (!world.has_level) {
    EnterLevel(world, now.agent.p_world.z());
    goal.p_looked_around_world = now.agent.p_world;
    QueueLookAround(goal, now.agent, now.config.action);
    return;
  }
  if (goal.paper.session || std::abs(now.agent.p_world.z() - world.level_m) < kOtherLevel_m) return;
  if (!policy::IsFlatAround(world.map, now.agent.p_world)) return;
  world.level_m = now.agent.p_world.z();
  goal.paper.commitment.reset();
  goal.events.push_back("on another level");
}

void ApplyMode(GoalState& goal, const ModeDecision& next, const Options& options) {
  const bool is_poi = next.mode == Mode::kPoiNavigation || next.mode == Mode::kTargetApproach;
  if (is_poi) {
    goal.paper.script.clear();
    goal.paper.entrance.reset();
    goal.paper.commitment.reset();
  }
  const int live = is_poi && next.uses_live_poi ? options.live_id : -1;
  if (live != goal.active_live) {
    goal.tried_viewpoints.clear();
    goal.failed_views = 0;
  }
  goal.active_live = live;
  goal.paper.active_history = is_poi && !next.uses_live_poi ? options.history_index : -1;
  if (next.mode != goal.paper.mode)
    goal.events.push_back("mode: " + std::string(NameOf(next.mode)));
  goal.paper.mode = next.mode;
  goal.paper.is_new = false;
  goal.paper.is_detection_rejected = false;
}

const std::optional<Target>& SelectTarget(const ModeDecision& next, const Options& options) {
  switch (next.mode) {
    case Mode::kStairExplore:
      return options.stair;
    case Mode::kPoiNavigation:
      return next.uses_live_poi ? options.live : options.history;
    case Mode::kTargetApproach:
      return options.live;
    case Mode::kBasicExplore:
      break;
  }
  return options.exploration;
}

std::optional<Action> Act(Situation& now, const ModeDecision& next,
                          const std::optional<Target>& target,
                          const policy::Verification& verification) {
  GoalState& goal = now.goal;
  if (next.mode == Mode::kStairExplore) return Climb(now, target);
  if (!goal.paper.script.empty()) {
    const Action scripted = goal.paper.script.front();
    goal.paper.script.pop_front();
    return scripted;
  }
  if (!target) return std::nullopt;
  if (next.mode == Mode::kBasicExplore) return Explore(now, *target);
  if (!next.uses_live_poi) return VisitHistoryPoi(now, *target);
  return Approach(now, *target, *goal.live.Find(goal.active_live), verification);
}

/// Without a target: remedies for overlooked candidates, from cheap to dear. False when all are
/// used.
bool Reconsider(Situation& now) {
  if (!now.world.paper.bumps.obstacles().empty()) {
    now.world.paper.bumps.Clear();
    now.goal.events.push_back("temporary obstacles forgotten");
    return true;
  }
  return LookAroundOnce(now) || Relax(now);
}

}  // namespace

Decision Decide(StepState& given) {
  World& world = given.world;
  GoalState& goal = given.goal;
  Situation now{given.config,
                world,
                goal,
                given.agent,
                given.eye,
                std::nullopt,
                &world.paper.bumps.obstacles()};
  NoticeBump(now);
  UpdateLevel(now);
  now.start = planner::StartVoxel(world.map, given.agent.p_world);
  std::optional<Action> look;
  const SessionVerdict session = CheckSession(now);
  const EntranceVerdict entrance = CheckEntrance(now, &look);
  world.UpdateStates();
  Options options = CollectCandidates(now);  // eq:supp_candidate_set
  Decision decision;
  decision.mode = NextMode(InputsFor(now, options, session, entrance));  // pure
  ApplyMode(goal, decision.mode, options);

  const auto& target = SelectTarget(decision.mode, options);  // eq:supp_candidate_priority
  const policy::LivePoi* claimed =
      decision.mode.uses_live_poi ? goal.live.Find(goal.active_live) : nullptr;
  if (claimed)
    decision.verification = VerifyNow(given, *claimed, given.config.policy.object.found_confidence);
  const bool is_looking = look && decision.mode.mode == Mode::kBasicExplore;
  decision.action = is_looking ? look : Act(now, decision.mode, target, decision.verification);
  if (!decision.action && Reconsider(now)) decision.action = Action::kTurnLeft;
  if (claimed && decision.action == Action::kStop)
    decision.p_claimed_world = claimed->p_center_world;
  if (target) {
    decision.target = target->candidate;
    decision.path = target->plan.path;
    decision.path_cost = target->plan.cost;
  }
  decision.shown = std::move(options.shown);
  world.paper.bumps.Commit(decision.action.value_or(Action::kTurnLeft), given.agent);
  return decision;
}

}  // namespace crossnav::agent::paper
