// SPDX-License-Identifier: MIT
#include "crossnav/agent/act.h"

#include <algorithm>
#include <string>

#include "crossnav/agent/claims.h"
#include "crossnav/agent/hints.h"
#include "crossnav/agent/object_search.h"
#include "crossnav/agent/passing_sights.h"
#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/pursuit.h"
#include "crossnav/agent/scan.h"
#include "crossnav/agent/settle.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/agent/whereabouts.h"
#include "crossnav/core/category_table.h"
#include "crossnav/policy/ground_motion.h"
#include "crossnav/policy/steering.h"

namespace crossnav::agent {

using policy::CandidateKind;

namespace {

constexpr double kArrived_m = 0.35;    // chosen: one forward step and a voxel
constexpr double kAtEnd_m = 1.0;       // chosen: of the end of a path: a look from there will do
constexpr int kLooksAtTarget = 6;      // chosen: half a turn, or less and a pitch
constexpr std::size_t kSides = 3;      // chosen: looks at a remembered place, from pairwise sides
constexpr double kTouching_m = 0.001;  // chosen: beside a blocked column, not in it

/// The next action along the path; nullopt at its end, or where no step helps.
std::optional<Action> Walk(StepState& now, Route& route) {
  policy::MotionConfig motion = now.config.policy.motion;
  const planner::GroundRules rules = RulesOf(now);
  if (rules.may_squeeze) motion.min_clearance_m = kTouching_m;
  if (auto pitch =
          policy::PitchTowards(now.agent, DegToRad(motion.travel_pitch_deg), now.config.action))
    return pitch;
  const bool is_clear = !route.motion.empty() &&
                        (route.motion.back() != Action::kMoveForward ||
                         IsStepClear(now.world.ground, now.agent, motion, now.config.action));
  if (!is_clear) {
    route.motion = MotionAlong(now.world.ground, route.path, now.agent, motion, now.config.planner,
                               now.config.action, rules);
    std::reverse(route.motion.begin(), route.motion.end());
  }
  if (route.motion.empty()) return std::nullopt;
  const Action next = route.motion.back();
  route.motion.pop_back();
  return next;
}

/// A turn or pitch towards `p_world`; nullopt when it is centred or `max_looks` were spent.
std::optional<Action> LookAt(StepState& now, Pursued& pursued, const Vector3d& p_world,
                             int max_looks) {
  if (pursued.looks >= max_looks) return std::nullopt;
  const auto look = policy::CenteringAction(now.eye, p_world, now.config.sensor.camera_height_m,
                                            now.config.action);
  if (look) {
    ++pursued.looks;
    pursued.route.motion.clear();
  }
  return look;
}

/// No step leads on from here; a few turns later the pursuit ends without progress.
Action TurnWithoutProgress(const Situation& now, Pursued& pursued) {
  pursued.route.idle_steps += now.config.policy.explore.progress_steps / 3;
  pursued.route.motion.clear();
  return Action::kTurnLeft;
}

/// On arrival the agent looks at the target once, then gives it up.
std::optional<Action> ActOnExploration(StepState& now, Pursued& pursued) {
  if (pursued.target.kind == CandidateKind::kSighting) {
    const policy::LivePoi* hint = now.goal.full.hints.Find(*pursued.target.poi_id);
    if (hint && IsHopelessHint(now, *hint)) {
      End(now, Ending::kRefuted);
      return std::nullopt;
    }
  }
  if (DistanceToEnd(now) > kArrived_m) {
    if (auto action = Walk(now, pursued.route)) return action;
    return TurnWithoutProgress(now, pursued);
  }
  if (auto look = LookAt(now, pursued, pursued.target.p_focus_world, kLooksAtTarget)) return look;
  pursued.looks = kLooksAtTarget;
  // The last part of the path may still show the target.
  if (DistanceToEnd(now) > now.config.policy.motion.arrival_m) {
    if (auto action = Walk(now, pursued.route)) return action;
  }
  if (pursued.target.kind == CandidateKind::kSearchView) SettleView(now, pursued.target);
  if (pursued.target.kind != CandidateKind::kSighting)
    End(now, Ending::kNotOpened);
  else
    End(now, NoteLook(now, *pursued.target.poi_id) ? Ending::kReached : Ending::kUndecided);
  return std::nullopt;
}

std::optional<Action> ActOn(StepState& /*now*/, Idle& /*idle*/, const policy::Verification& /*v*/) {
  return std::nullopt;
}
std::optional<Action> ActOn(StepState& now, GoTo& go_to, const policy::Verification& /*v*/) {
  return ActOnExploration(now, go_to);
}
std::optional<Action> ActOn(StepState& now, Climb& climb, const policy::Verification& /*v*/) {
  return ActOnExploration(now, climb);
}

/// A thing is missed from one side, because it is thin or because another thing hides it. False
/// where the place was looked at from enough sides.
bool AskForOtherSide(StepState& now, HistoryPoi& poi) {
  poi.p_looked_world.push_back(now.agent.p_world);
  if (poi.p_looked_world.size() >= kSides || !HasOtherSide(now, poi)) return false;
  poi.looked = 0;
  now.goal.events.push_back("not seen here: another side is tried");
  return true;
}

/// The frame shows the thing at the place, and the detector has another name for it. Where single
/// frames are no evidence, an object has a wrong name from some sides.
bool IsSeenAsAnother(const Situation& now, const HistoryPoi& poi) {
  return NoticesThings(now.config) && !JudgesByViews(now.config) &&
         IsShownAsAnother(now.world, now.goal, poi) &&
         (poi.p_center_world - now.agent.p_world).norm() <=
             RangesOfNotice(now.world, now.goal, now.config).surely_m;
}

/// The goal is not at the place.
void GiveUpPlace(StepState& now, HistoryPoi& poi, const std::string& event) {
  poi.is_exhausted = true;
  if (now.world.revision)
    now.world.objects.Disprove(SpacedName(now.goal.goal), poi.voxels,
                               {now.world.day, now.world.step});
  now.goal.events.push_back(event);
  End(now, Ending::kReached);
}

std::optional<Action> ActOn(StepState& now, VisitPlace& visit, const policy::Verification& /*v*/) {
  HistoryPoi& poi = now.goal.history[static_cast<std::size_t>(visit.place)];
  if (IsSeenAsAnother(now, poi)) {
    GiveUpPlace(now, poi, "history POI is another thing");
    return std::nullopt;
  }
  if (DistanceToEnd(now) > now.config.policy.motion.arrival_m && poi.looked == 0) {
    if (auto action = Walk(now, visit.route)) return action;
    if (DistanceToEnd(now) > kAtEnd_m) return TurnWithoutProgress(now, visit);
  }
  const Vector3d p_aim = policy::AimPoint(poi.voxels, now.agent.p_world, now.config.map.voxel_m);
  if (poi.looked == 0) {
    if (auto look = LookAt(now, visit, p_aim, 2 * kLooksAtTarget)) return look;
  }
  // Once aimed, a wobble to either side gives the detector a few more frames.
  if (const auto wobble = static_cast<std::size_t>(poi.looked); wobble < kWobble.size())
    return ++poi.looked, kWobble[wobble];
  if (SettleForSightAt(now, poi) || AskForOtherSide(now, poi)) {
    End(now, Ending::kUndecided);
    return std::nullopt;
  }
  GiveUpPlace(now, poi,
              "history POI without success, similarity " + std::to_string(poi.similarity) +
                  " score " + std::to_string(poi.score));
  return std::nullopt;
}

std::optional<Action> ActOn(StepState& now, Approach& approach,
                            const policy::Verification& verification) {
  GoalState& goal = now.goal;
  const policy::LivePoi* poi = goal.live.Find(approach.poi_id);
  if (DistanceToEnd(now) > now.config.policy.motion.arrival_m) {
    if (auto action = Walk(now, approach.route)) return action;
  }
  const Vector3d p_aim = policy::AimPoint(poi->voxels, now.agent.p_world, now.config.map.voxel_m);
  if (auto look = LookAt(now, approach, p_aim, 2 * kLooksAtTarget)) return look;
  goal.tried_viewpoints.push_back(now.agent.p_world);
  goal.events.push_back("view failed: " + verification.failed_check);
  approach.looks = 0;
  if (verification.failed_check == "confidence") goal.full.doubtful_m = verification.distance_m;
  if (++goal.failed_views >= now.config.policy.approach.max_viewpoints &&
      !DecideByViews(now, *poi) && !ReturnToClaim(now, *poi)) {
    Reject(now, *poi);
    goal.events.push_back("verification failed: " + verification.failed_check);
    End(now, Ending::kRefuted);
  }
  return Action::kTurnLeft;
}

}  // namespace

std::optional<Action> Act(StepState& now, const policy::Verification& verification) {
  Activity& activity = now.goal.full.activity;
  if (const Scan* scan = std::get_if<Scan>(&activity); scan && HasEscaped(now, *scan)) EndScan(now);
  if (Scan* scan = std::get_if<Scan>(&activity)) {
    const Action turn = scan->turns.front();
    scan->turns.pop_front();
    if (scan->turns.empty()) EndScan(now);
    return turn;
  }
  return std::visit([&](auto& pursuit) { return ActOn(now, pursuit, verification); },
                    PursuitOf(activity));
}

}  // namespace crossnav::agent
