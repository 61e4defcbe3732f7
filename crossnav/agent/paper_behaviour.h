// SPDX-License-Identifier: MIT
// policy.profile = paper. Actions of each mode towards a chosen target, one action per call, and
// the checks that decide about modes: entrances and sessions.
#pragma once

#include <optional>

#include "crossnav/agent/paper_targets.h"
#include "crossnav/core/observation.h"
#include "crossnav/policy/approach.h"

namespace crossnav::agent::paper {

/// A full turn on the spot with the camera one step down: sees the ground at the feet too.
void QueueLookAround(GoalState& goal, const AgentPose& agent, const ActionConfig& action);

/// A forward step that did not move: an obstacle ahead; after the third bump, an escape from there.
void NoticeBump(Situation& now);

/// One action along the plan: pitch first, then turn or walk. nullopt at its end.
std::optional<Action> FollowPath(const Situation& now, const Target& target,
                                 double wanted_pitch_rad = 0);

/// Ground distance from the agent to the end of the plan [m].
double DistanceToGoal(const Situation& now, const Target& target);

enum class EntranceVerdict { kNone, kLooking, kVerified, kRejected };

/// Looks at the entrance in front of the agent and decides (paper, "Stair-State Promotion"). While
/// looking, `*look` is the next action. kVerified has begun a session; kRejected has set it aside.
EntranceVerdict CheckEntrance(Situation& now, std::optional<Action>* look);

enum class SessionVerdict { kNone, kClimbing, kLandingReached, kFailed };

/// Promotes evidence, returns the state of the session, and ends a finished session.
SessionVerdict CheckSession(Situation& now);

/// One step of Basic Explore towards `target`; may begin an entrance check.
std::optional<Action> Explore(Situation& now, const Target& target);

/// One step of Stair Explore; nullopt when no stair frontier can be reached.
std::optional<Action> Climb(Situation& now, const std::optional<Target>& target);

/// One step towards a history POI; looks at it on arrival and gives it up when nothing shows.
std::optional<Action> VisitHistoryPoi(Situation& now, const Target& target);

/// One step towards a live POI, with verification; kStop when the frame proves the object.
std::optional<Action> Approach(Situation& now, const Target& target, const policy::LivePoi& poi,
                               const policy::Verification& verification);

/// Queues a look around, at most once per place and goal, for surroundings that were never in view.
/// False if done before.
bool LookAroundOnce(Situation& now);

/// The one relaxed retry when nothing is left. False if it was used before.
bool Relax(Situation& now);

}  // namespace crossnav::agent::paper
