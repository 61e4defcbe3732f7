// SPDX-License-Identifier: MIT
#include "crossnav/agent/navigator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/agent/act.h"
#include "crossnav/agent/choose.h"
#include "crossnav/agent/claims.h"
#include "crossnav/agent/hooks.h"
#include "crossnav/agent/last_resort.h"
#include "crossnav/agent/object_search.h"
#include "crossnav/agent/patience.h"
#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/progress.h"
#include "crossnav/agent/remembered_places.h"
#include "crossnav/agent/settle.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/agent/wanted_instance.h"

namespace crossnav::agent {

using policy::ClaimVerdict;
using policy::Mode;
using policy::ModeReason;

namespace {

constexpr double kNear_m = 1.0;  // chosen: of the viewpoint: aim and verify
constexpr int kChoices = 8;      // chosen: in one step, of which all but the last end at once

/// Verdict of the memory on the claim of this frame, and of the user's hook on both.
ClaimVerdict JudgeClaim(StepState& now, const policy::LivePoi& poi,
                        const policy::Verification& verification) {
  const auto verdict = verification.passed     ? CheckClaim(now, poi, verification)
                       : IsDisproved(now, poi) ? ClaimVerdict::kRefuted
                                               : ClaimVerdict::kWeak;
  return now.hooks ? now.hooks->JudgeClaim(now, {poi, verification, verdict}) : verdict;
}

/// Issues STOP where this frame confirms a live POI. False if it confirms none.
bool TryConfirmGoal(StepState& now, Decision& decision) {
  for (const policy::LivePoi* poi : now.goal.live.Stable(now.config.policy.object)) {
    auto verification = VerifyNow(now, *poi, ConfidenceForStop(now, poi->id));
    verification.passed = verification.passed || IsDecidedByViews(now, *poi, verification);
    if (verification.passed &&
        !ObjectStorey(now, poi->voxels, poi->p_center_world).Has(now.agent.p_world)) {
      verification.passed = false;
      verification.failed_check = "storey";
    }
    const auto verdict = JudgeClaim(now, *poi, verification);
    if (verification.passed && verdict == ClaimVerdict::kWeak)
      verification.failed_check = "second view";
    if (verdict == ClaimVerdict::kRefuted) {
      verification.failed_check = verification.passed ? "memory" : "views";
      Reject(now, *poi);
    }
    verification.passed = verdict == ClaimVerdict::kAgreed;
    if (verification.passed) verification.failed_check.clear();
    if (poi->id == now.goal.active_live || verification.passed)
      decision.verification = verification;
    if (!verification.passed) continue;
    if (const auto similarity = SimilarityAt(now.world, now.goal, poi->voxels)) {
      double& confirmed = now.world.full.confirmed_similarity;
      confirmed = confirmed < 0 ? *similarity : std::min(confirmed, *similarity);
    }
    now.goal.active_live = poi->id;
    policy::Candidate claimed = CandidateOf(*poi);
    decision.shown.push_back(claimed);
    decision.target = std::move(claimed);
    decision.p_claimed_world = poi->p_center_world;
    decision.action = Action::kStop;
    decision.mode = {Mode::kTargetApproach, ModeReason::kNearTarget, true};
    return true;
  }
  return false;
}

policy::ModeDecision ModeOf(const Situation& now) {
  const Pursuit& pursuit = PursuitOf(now.goal.full.activity);
  const bool is_on_flight = std::abs(now.agent.p_world.z() - now.world.level_m) >=
                            now.config.policy.frontier.level_band_m;
  if (const Approach* approach = std::get_if<Approach>(&pursuit)) {
    if (RemainingOf(now, approach->route.path) <= kNear_m)
      return {Mode::kTargetApproach, ModeReason::kNearTarget, true};
    return {Mode::kPoiNavigation, ModeReason::kLivePoi, true};
  }
  if (std::holds_alternative<VisitPlace>(pursuit))
    return {Mode::kPoiNavigation, ModeReason::kHistoryPoi, false};
  if (std::holds_alternative<Climb>(pursuit) && is_on_flight)
    return {Mode::kStairExplore, ModeReason::kClimbing};
  return {Mode::kBasicExplore, ModeReason::kExploring};
}

bool IsIdle(const Situation& now) {
  const Activity& activity = now.goal.full.activity;
  return !IsScanning(activity) && !PursuedIn(PursuitOf(activity));
}

/// Chooses until an activity stands. Returns the candidates for the trace.
std::vector<policy::Candidate> ChooseActivity(StepState& now) {
  for (;;) {
    Choice choice = Choose(now);
    const bool is_final = !std::holds_alternative<Drop>(choice.next);
    std::vector<policy::Candidate> shown = std::move(choice.shown);
    Apply(now, std::move(choice));
    if (is_final) return shown;
  }
}

/// Target and path of the pursuit, for the trace.
void ShowPursuit(const Situation& now, Decision* decision) {
  const Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity));
  if (!pursued) return;
  const policy::Candidate& target = pursued->target;
  const auto is_target = [&](const policy::Candidate& c) {
    return c.kind == target.kind && c.p_focus_world == target.p_focus_world;
  };
  if (std::none_of(decision->shown.begin(), decision->shown.end(), is_target))
    decision->shown.push_back(target);
  decision->target = target;
  decision->path = pursued->route.path;
  decision->path_cost = RemainingOf(now, pursued->route.path) / now.config.map.voxel_m;
}

/// Chooses and acts; an activity that ends without an action makes room for another choice.
void ChooseAndAct(StepState& now, Decision* decision) {
  bool is_at_loss = false;
  for (int i = 0; i < kChoices && !decision->action && !is_at_loss; ++i) {
    if (i > 0) BeginSearchWhereDue(now);    // a visit may have ended
    decision->shown = ChooseActivity(now);  // eq:supp_candidate_set, eq:supp_candidate_priority
    is_at_loss = IsIdle(now);
    decision->action = Act(now, decision->verification);
  }
  decision->mode = ModeOf(now);
  ShowPursuit(now, decision);
  if (!decision->action && (!is_at_loss || TryLastResort(now)))
    decision->action = Action::kTurnLeft;
}

}  // namespace

Decision Navigate(StepState& now) {
  Decision decision;
  NoteBump(now);
  NoteLevel(now);
  now.world.full.looked_along.Add(now.eye, DegToRad(now.config.sensor.hfov_deg));
  MeasureProgress(now);
  UpdateSearch(now);
  JudgeInstances(now);
  LosePatience(now);
  OpenWayToSteadySight(now);
  if (!TryConfirmGoal(now, decision)) ChooseAndAct(now, &decision);
  if (decision.action == Action::kMoveForward) now.world.full.before_forward = now.agent;
  decision.activity = NameOf(now.goal.full.activity);
  return decision;
}

}  // namespace crossnav::agent
