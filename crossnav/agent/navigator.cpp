// SPDX-License-Identifier: MIT
#include "crossnav/agent/navigator.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "crossnav/agent/claims.h"
#include "crossnav/agent/explore.h"
#include "crossnav/agent/hooks.h"
#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/progress.h"
#include "crossnav/agent/remembered_places.h"
#include "crossnav/policy/ground_motion.h"
#include "crossnav/policy/steering.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using policy::CandidateKind;
using policy::ClaimVerdict;
using policy::Mode;
using policy::ModeReason;

namespace {

constexpr double kNear_m = 1.0;      // chosen: of the viewpoint: aim and verify
constexpr double kArrived_m = 0.35;  // chosen: one forward step and a voxel
constexpr int kLooksAtTarget = 6;    // chosen: half a turn, or less and a pitch
constexpr int kChoices = 8;          // chosen: in one step, of which all but the last end at once
constexpr int kWobbles = 3;          // chosen: one more than a live POI needs to be stable

/// The next action along the way; nullopt at its end, or where no step helps.
std::optional<Action> Walk(Situation& now) {
  Activity& activity = now.goal.activity;
  const auto& motion = now.config.policy.motion;
  if (auto pitch =
          policy::PitchTowards(now.agent, DegToRad(motion.travel_pitch_deg), now.config.action))
    return pitch;
  const bool is_clear = !activity.motion.empty() &&
                        (activity.motion.back() != Action::kMoveForward ||
                         IsStepClear(now.world.ground, now.agent, motion, now.config.action));
  if (!is_clear) {
    activity.motion = MotionAlong(now.world.ground, activity.path, now.agent, motion,
                                  now.config.planner, now.config.action);
    std::reverse(activity.motion.begin(), activity.motion.end());
  }
  if (activity.motion.empty()) return std::nullopt;
  const Action next = activity.motion.back();
  activity.motion.pop_back();
  return next;
}

/// A turn or pitch towards `p_world`; nullopt when it is centred or enough looks were spent.
std::optional<Action> LookAt(Situation& now, const Vector3d& p_world, int max_looks) {
  Activity& activity = now.goal.activity;
  if (activity.looks >= max_looks) return std::nullopt;
  const auto look = policy::CenteringAction(now.eye, p_world, now.config.sensor.camera_height_m,
                                            now.config.action);
  if (look) {
    ++activity.looks;
    activity.motion.clear();
  }
  return look;
}

// --- Choosing ----------------------------------------------------------------------------------

ActivityKind KindFor(const Situation& now, const VoxelKey& destination) {
  const bool is_climb = IsOverStairs(now, CenterOf(destination, now.config.map.voxel_m));
  return is_climb ? ActivityKind::kClimb : ActivityKind::kGoTo;
}

/// Goes on with the exploration target while it is open and its way holds; chooses again after the
/// grace period.
void Explore(Situation& now, const VoxelKey& start, Decision& decision) {
  Activity& activity = now.goal.activity;
  if (IsExploring(activity)) {
    if (!IsStillOpen(now, activity.candidate)) {
      End(now, Ending::kGone);
    } else if (KeepToPath(now) &&
               activity.steps % now.config.policy.explore.reconsider_steps != 0) {
      return;
    }
  }
  auto target = ChooseExploration(now, start, &decision.shown);
  if (!target) {
    if (IsExploring(activity)) End(now, Ending::kUnreachable);
    return;
  }
  const ActivityKind kind = KindFor(now, target->path.back());
  Begin(now, kind, std::move(*target));
}

// --- Acting ------------------------------------------------------------------------------------

/// On arrival at an exploration target: look at what it is about, then give it up.
std::optional<Action> ActOnExploration(Situation& now) {
  Activity& activity = now.goal.activity;
  if (DistanceToEnd(now) > kArrived_m) {
    if (auto action = Walk(now)) return action;
    activity.idle_steps += now.config.policy.explore.progress_steps / 3;
    activity.motion.clear();
    return Action::kTurnLeft;
  }
  if (auto look = LookAt(now, activity.candidate.p_focus_world, kLooksAtTarget)) return look;
  activity.looks = kLooksAtTarget;  // looked at: once is enough
  // The last part of the way may still show it.
  if (DistanceToEnd(now) > now.config.policy.motion.arrival_m) {
    if (auto action = Walk(now)) return action;
  }
  const bool is_sighting = activity.candidate.kind == CandidateKind::kSighting;
  End(now, is_sighting ? Ending::kReached : Ending::kNotOpened);
  return std::nullopt;
}

std::optional<Action> ActOnVisit(Situation& now) {
  Activity& activity = now.goal.activity;
  HistoryPoi& poi = now.goal.history[static_cast<std::size_t>(activity.candidate.id)];
  if (DistanceToEnd(now) > now.config.policy.motion.arrival_m && poi.looked == 0) {
    if (auto action = Walk(now)) return action;
  }
  const Vector3d p_aim = policy::AimPoint(poi.voxels, now.agent.p_world, now.config.map.voxel_m);
  if (poi.looked == 0) {
    if (auto look = LookAt(now, p_aim, 2 * kLooksAtTarget)) return look;
  }
  // Aimed: a wobble to either side gives the detector a few more frames.
  constexpr Action kWobble[kWobbles] = {Action::kTurnLeft, Action::kTurnRight, Action::kTurnRight};
  if (poi.looked < kWobbles) return kWobble[poi.looked++];
  poi.is_exhausted = true;
  now.goal.events.push_back("history POI without success, similarity " +
                            std::to_string(poi.similarity) + " score " + std::to_string(poi.score));
  End(now, Ending::kReached);
  return std::nullopt;
}

std::optional<Action> ActOnApproach(Situation& now, const policy::Verification& verification) {
  Activity& activity = now.goal.activity;
  GoalState& goal = now.goal;
  const policy::LivePoi* poi = goal.live.Find(activity.candidate.id);
  if (DistanceToEnd(now) > now.config.policy.motion.arrival_m) {
    if (auto action = Walk(now)) return action;
  }
  const Vector3d p_aim = policy::AimPoint(poi->voxels, now.agent.p_world, now.config.map.voxel_m);
  if (auto look = LookAt(now, p_aim, 2 * kLooksAtTarget)) return look;
  goal.tried_viewpoints.push_back(now.agent.p_world);
  goal.events.push_back("view failed: " + verification.failed_check);
  activity.looks = 0;
  if (++goal.failed_views >= now.config.policy.approach.max_viewpoints) {
    Reject(now, *poi);
    goal.events.push_back("verification failed: " + verification.failed_check);
    End(now, Ending::kRefuted);
  }
  return Action::kTurnLeft;
}

// --- Nothing left ------------------------------------------------------------------------------

/// The next thing to try when no candidate is left; each is tried once for a goal. False if none
/// is left either.
bool TryLastResort(Situation& now) {
  GoalState& goal = now.goal;
  for (HistoryPoi& poi : goal.history) poi.unreachable_step.reset();
  while (goal.last_resorts < 4) {
    switch (goal.last_resorts++) {
      case 0:
        if ((goal.p_looked_around_world - now.agent.p_world).norm() < 0.5) continue;
        QueueLookAround(now);
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
        goal.attempts.clear();
        goal.live.ForgiveDiscarded();
        goal.tried_viewpoints.clear();
        goal.failed_views = 0;
        now.world.coverage.Clear();
        goal.inspect_range_m *= 0.6;  // chosen: near enough for the smallest category
        now.world.ground.ForgetBlocked();
        goal.events.push_back("nothing left: trying once more with relaxed limits");
        return true;
    }
  }
  return false;
}

// --- One decision ------------------------------------------------------------------------------

/// The memory's word on what this frame says of `poi`, and the user's on that.
ClaimVerdict JudgeClaim(Situation& now, const policy::LivePoi& poi,
                        const policy::Verification& verification) {
  const auto verdict =
      verification.passed ? CheckClaim(now, poi, verification) : ClaimVerdict::kWeak;
  return now.hooks ? now.hooks->JudgeClaim(now, {poi, verification, verdict}) : verdict;
}

/// Whether this frame proves an object that the agent stands before.
bool Prove(Situation& now, Decision& decision) {
  const auto& config = now.config;
  for (const policy::LivePoi* poi : now.goal.live.Stable(config.policy.object)) {
    auto verification =
        policy::Verify(*poi, now.sightings, {now.obs, now.agent, config.sensor.camera_height_m},
                       config.policy, config.map.voxel_m);
    const auto verdict = JudgeClaim(now, *poi, verification);
    if (verification.passed && verdict == ClaimVerdict::kWeak)
      verification.failed_check = "second view";
    if (verdict == ClaimVerdict::kRefuted) {
      verification.failed_check = "memory";
      Reject(now, *poi);
    }
    verification.passed = verdict == ClaimVerdict::kAgreed;
    if (verification.passed) verification.failed_check.clear();
    if (poi->id == now.goal.active_live || verification.passed)
      decision.verification = verification;
    if (!verification.passed) continue;
    if (const auto similarity = SimilarityAt(now.world, now.goal, poi->voxels)) {
      double& confirmed = now.world.confirmed_similarity;
      confirmed = confirmed < 0 ? *similarity : std::min(confirmed, *similarity);
    }
    now.goal.active_live = poi->id;
    policy::Candidate claimed;
    claimed.kind = CandidateKind::kLivePoi;
    claimed.id = poi->id;
    claimed.p_focus_world = poi->p_center_world;
    claimed.size = static_cast<int>(poi->voxels.size());
    claimed.score = poi->confidence;
    decision.shown.push_back(claimed);
    decision.target = std::move(claimed);
    decision.p_claimed_world = poi->p_center_world;
    decision.action = Action::kStop;
    decision.mode = {Mode::kTargetApproach, ModeReason::kNearTarget, true};
    return true;
  }
  return false;
}

void ChooseActivity(Situation& now, Decision& decision) {
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  Activity& activity = now.goal.activity;
  if (!start) {
    End(now, Ending::kUnreachable);
    return;
  }
  if (auto live = ChooseLivePoi(now, *start)) {
    if (live->candidate.id != now.goal.active_live) {
      now.goal.tried_viewpoints.clear();
      now.goal.failed_views = 0;
    }
    if (activity.kind == ActivityKind::kVisit) {
      const HistoryPoi& poi = now.goal.history[static_cast<std::size_t>(activity.candidate.id)];
      now.goal.events.push_back("history POI led to the goal, similarity " +
                                std::to_string(poi.similarity) + " score " +
                                std::to_string(poi.score));
    }
    now.goal.active_live = live->candidate.id;
    now.goal.script.clear();
    decision.shown.push_back(live->candidate);
    Begin(now, ActivityKind::kApproach, std::move(*live));
    return;
  }
  if (activity.kind == ActivityKind::kApproach) End(now, Ending::kUnreachable);
  if (!now.goal.script.empty()) return;
  if (activity.kind == ActivityKind::kVisit && KeepToPath(now)) return;
  if (auto history = ChooseHistoryPoi(now, *start)) {
    decision.shown.push_back(history->candidate);
    Begin(now, ActivityKind::kVisit, std::move(*history));
    return;
  }
  if (activity.kind == ActivityKind::kVisit) End(now, Ending::kUnreachable);
  if (IsOnLevel(now, now.agent.p_world) && QueueGlance(now, *start)) return;
  Explore(now, *start, decision);
}

policy::ModeDecision ModeOf(const Situation& now) {
  const Activity& activity = now.goal.activity;
  const bool is_on_flight = std::abs(now.agent.p_world.z() - now.world.level_m) >=
                            now.config.policy.frontier.level_band_m;
  switch (activity.kind) {
    case ActivityKind::kApproach:
      if (RemainingOf(now, activity.path) <= kNear_m)
        return {Mode::kTargetApproach, ModeReason::kNearTarget, true};
      return {Mode::kPoiNavigation, ModeReason::kLivePoi, true};
    case ActivityKind::kVisit:
      return {Mode::kPoiNavigation, ModeReason::kHistoryPoi, false};
    case ActivityKind::kClimb:
      if (is_on_flight) return {Mode::kStairExplore, ModeReason::kClimbing};
      break;
    default:
      break;
  }
  return {Mode::kBasicExplore, ModeReason::kExploring};
}

std::optional<Action> Act(Situation& now, const policy::Verification& verification) {
  GoalState& goal = now.goal;
  if (!goal.script.empty()) {
    const Action scripted = goal.script.front();
    goal.script.pop_front();
    return scripted;
  }
  switch (goal.activity.kind) {
    case ActivityKind::kGoTo:
    case ActivityKind::kClimb:
      return ActOnExploration(now);
    case ActivityKind::kVisit:
      return ActOnVisit(now);
    case ActivityKind::kApproach:
      return ActOnApproach(now, verification);
    default:
      return std::nullopt;
  }
}

}  // namespace

Decision Navigate(Situation& now) {
  Decision decision;
  NoteBump(now);
  NoteLevel(now);
  now.world.looked_along.Add(now.eye, DegToRad(now.config.sensor.hfov_deg));
  MeasureProgress(now);
  if (!Prove(now, decision)) {
    bool is_at_loss = false;
    for (int i = 0; i < kChoices && !decision.action && !is_at_loss; ++i) {
      decision.shown.clear();
      ChooseActivity(now, decision);  // eq:supp_candidate_set, eq:supp_candidate_priority
      is_at_loss = now.goal.activity.kind == ActivityKind::kNone && now.goal.script.empty();
      decision.action = Act(now, decision.verification);
    }
    decision.mode = ModeOf(now);
    const Activity& activity = now.goal.activity;
    if (activity.kind != ActivityKind::kNone) {
      decision.target = activity.candidate;
      const bool is_shown = std::any_of(
          decision.shown.begin(), decision.shown.end(), [&](const policy::Candidate& c) {
            return c.kind == activity.candidate.kind &&
                   c.p_focus_world == activity.candidate.p_focus_world;
          });
      if (!is_shown) decision.shown.push_back(activity.candidate);
      decision.path = activity.path;
      decision.path_cost = RemainingOf(now, activity.path) / now.config.map.voxel_m;
    }
    if (!decision.action && (!is_at_loss || TryLastResort(now)))
      decision.action = Action::kTurnLeft;
  }
  if (decision.action == Action::kMoveForward) now.world.before_forward = now.agent;
  decision.activity = now.goal.script.empty() ? NameOf(now.goal.activity.kind) : "look_around";
  return decision;
}

}  // namespace crossnav::agent
