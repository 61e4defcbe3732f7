// SPDX-License-Identifier: MIT
#include "crossnav/agent/paper_behaviour.h"

#include <algorithm>
#include <cmath>

#include "crossnav/agent/remembered_places.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/policy/flights.h"

namespace crossnav::agent::paper {

using geometry::VoxelKey;
using policy::BlacklistedPlace;
using policy::CandidateKind;
using policy::CenteringAction;

namespace {

constexpr double kArrived_m = 0.20;  // chosen: less than one forward step
constexpr int kLooksAtFrontier = 2;  // chosen
constexpr int kMaxPitches = 4;       // chosen: from the lowest pitch to one up, and one more
constexpr double kFrontierBlacklist_m = 0.4;  // chosen: a few voxels that cannot be seen

/// Centre of the frontier's unknown voxels near the agent: the heading on arrival.
Vector3d LocalFocus(const Situation& now, const policy::Candidate& candidate) {
  const double voxel_m = now.config.map.voxel_m;
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < candidate.beyond.size(); ++i) {
    const Vector3d p = CenterOf(candidate.standing[i], voxel_m);
    if ((p - now.agent.p_world).head<2>().norm() > 0.8) continue;  // chosen
    sum += CenterOf(candidate.beyond[i], voxel_m);
    ++count;
  }
  return count ? Vector3d(sum / count) : candidate.p_focus_world;
}

/// The turn, without pitch, that brings `p_world` ahead.
std::optional<Action> FaceAction(const Situation& now, const Vector3d& p_world) {
  const double camera_m = now.config.sensor.camera_height_m;
  Vector3d p_level = p_world;
  p_level.z() = now.eye.p_world.z() + camera_m +
                std::tan(now.eye.pitch_rad) * (p_world - now.eye.p_world).head<2>().norm();
  return CenteringAction(now.eye, p_level, camera_m, now.config.action);
}

const policy::Flight* NearestFlight(const std::vector<policy::Flight>& flights,
                                    const Vector3d& p_world) {
  const policy::Flight* nearest = nullptr;
  double best_m = 1.6;  // chosen: the entrance is in front of the agent
  for (const policy::Flight& flight : flights) {
    const double d = (flight.p_entrance_world - p_world).head<2>().norm();
    if (d >= best_m) continue;
    best_m = d;
    nearest = &flight;
  }
  return nearest;
}

bool IsVerified(const policy::Flight& flight, const policy::StairConfig& config) {
  if (flight.direction > 0)
    return flight.is_confirmed && flight.geometry_score >= config.geometry_threshold;
  return (flight.probability + flight.geometry_score) / 2 >= config.descent_confirmation;
}

void RejectEntrance(Situation& now, const Vector3d& p_focus_world) {
  const auto& poi = now.config.policy.poi;
  const auto keys =
      now.world.stairs.Reject(p_focus_world, poi.blacklist_xy_m, now.config.map.voxel_m);
  now.world.map.MarkStair(keys, geometry::StairMark::kFake);
  now.goal.paper.set_aside.push_back({p_focus_world, poi.blacklist_xy_m, poi.blacklist_z_m});
  now.goal.paper.commitment.reset();
  now.goal.paper.entrance.reset();
  now.goal.events.push_back("entrance rejected");
}

void StartSession(Situation& now, const policy::Flight& flight) {
  std::vector<VoxelKey> first;
  for (const VoxelKey& key : flight.voxels) {
    const Vector3d d = CenterOf(key, now.config.map.voxel_m) - flight.p_entrance_world;
    if (d.norm() <= now.config.policy.stair.admission_radius_m) first.push_back(key);
  }
  now.goal.paper.session =
      policy::BeginSession(flight.direction, now.world.level_m, now.agent.p_world, first);
  policy::PromoteStairs(*now.goal.paper.session, now.world.stairs, now.world.map,
                        now.config.policy.stair);
  now.world.path_off_level_world.assign(1, now.agent.p_world);
  now.goal.paper.steps_without_stair_target = 0;
  now.goal.paper.scanned_landing_m = -1e9;
  now.goal.paper.commitment.reset();
  now.goal.paper.entrance.reset();
  now.goal.paper.script.clear();
  now.goal.events.push_back(flight.direction > 0 ? "stairs up verified" : "stairs down verified");
}

/// A new exploration level, or back to where the session began.
void EndSession(Situation& now, bool is_success) {
  const policy::StairSession session = *now.goal.paper.session;
  now.goal.paper.session.reset();
  now.goal.paper.script.clear();
  if (is_success) {
    now.world.path_off_level_world.push_back(now.agent.p_world);
    policy::NoteWalk(now.world.path_off_level_world, now.world.stairs, now.config.map.voxel_m,
                     &now.world.flights);
    EnterLevel(now.world, now.agent.p_world.z());
    now.world.paper.last_direction = session.direction;
    now.goal.events.push_back(session.direction > 0 ? "new level above" : "new level below");
    return;
  }
  const auto& poi = now.config.policy.poi;
  now.goal.paper.set_aside.push_back(
      {session.p_entrance_world, 2 * poi.blacklist_xy_m, poi.blacklist_z_m});
  policy::NoteTry(session.p_entrance_world,
                  {now.agent.p_world, session.direction > 0, geometry::TryEnding::kGivenUp},
                  &now.world.flights);
  now.goal.events.push_back("stairs given up");
}

}  // namespace

void QueueLookAround(GoalState& goal, const AgentPose& agent, const ActionConfig& action) {
  // One pitch step down: the ground at the feet and everything up to above the horizon is in view.
  const double down_rad = -DegToRad(action.pitch_deg);
  const auto turn = FullTurn(agent, down_rad, action);
  goal.paper.script.insert(goal.paper.script.end(), turn.begin(), turn.end());
}

void NoticeBump(Situation& now) {
  auto& bumps = now.world.paper.bumps;
  if (!bumps.Update(now.agent, now.world.step, now.config.map)) return;
  now.goal.events.push_back("bump");
  if (bumps.bumps_in_place() < 3) return;  // chosen: two tries, then another route
  const auto escape =
      policy::EscapeActions(now.world.map, now.agent, bumps.bumped_yaws(), now.config.action);
  now.goal.paper.script.assign(escape.begin(), escape.end());
  now.goal.events.push_back("stuck: stepping aside");
}

double DistanceToGoal(const Situation& now, const Target& target) {
  return DistanceToEndOf(target.plan.path, now.agent.p_world, now.config.map.voxel_m);
}

std::optional<Action> FollowPath(const Situation& now, const Target& target,
                                 double wanted_pitch_rad) {
  if (auto pitch = policy::PitchTowards(now.agent, wanted_pitch_rad, now.config.action))
    return pitch;
  if (DistanceToGoal(now, target) < 0.05) return std::nullopt;
  const Vector3d p =
      policy::VisibleWaypoint(now.world.map, target.plan.path, now.agent.p_world, target.rules);
  return policy::SteerTowards(now.world.map, now.agent, p, now.obstacles, now.config.action);
}

EntranceVerdict CheckEntrance(Situation& now, std::optional<Action>* look) {
  if (!now.goal.paper.entrance) return EntranceVerdict::kNone;
  EntranceCheck& check = *now.goal.paper.entrance;
  if (auto turn = FaceAction(now, check.p_focus_world)) {
    if (++check.frames < 12) {
      *look = turn;
      return EntranceVerdict::kLooking;
    }
  }
  const int direction = check.kind == CandidateKind::kAscentFrontier ? 1 : -1;
  const auto flights =
      policy::FlightsFrom(now.world.stairs, now.world.map, now.world.level_m, direction);
  const policy::Flight* flight = NearestFlight(flights, now.agent.p_world);
  // Up once, down twice, from level: whatever the pitch was on arrival.
  const double step_rad = DegToRad(now.config.action.pitch_deg);
  const bool is_looking = direction * now.agent.pitch_rad > 0.5 * step_rad;
  if (is_looking && flight && IsVerified(*flight, now.config.policy.stair)) {
    StartSession(now, *flight);
    return EntranceVerdict::kVerified;
  }
  const double max_rad = DegToRad(now.config.action.max_pitch_deg);
  const double wanted_rad = std::clamp(direction > 0 ? step_rad : -2 * step_rad, -max_rad, max_rad);
  const auto pitch = policy::PitchTowards(now.agent, wanted_rad, now.config.action);
  if (!pitch || check.looks >= kMaxPitches) {
    RejectEntrance(now, check.p_focus_world);
    return EntranceVerdict::kRejected;
  }
  ++check.looks;
  *look = pitch;
  return EntranceVerdict::kLooking;
}

SessionVerdict CheckSession(Situation& now) {
  if (!now.goal.paper.session) return SessionVerdict::kNone;
  GoalState& goal = now.goal;
  policy::StairSession& session = *goal.paper.session;
  NoteOffLevel(now.world, now.agent.p_world, now.config.map.voxel_m);
  policy::PromoteStairs(session, now.world.stairs, now.world.map, now.config.policy.stair);
  const auto status =
      policy::AdvanceSession(session, now.world.map, now.agent.p_world, now.config.policy.stair);
  if (!goal.paper.script.empty()) return SessionVerdict::kClimbing;  // still looking around
  if (status == policy::SessionStatus::kOnLanding) {
    const bool is_scanned = std::abs(goal.paper.scanned_landing_m - now.agent.p_world.z()) < 0.3;
    if (!is_scanned) {
      goal.paper.scanned_landing_m = now.agent.p_world.z();
      goal.events.push_back("looking around on the landing");
      QueueLookAround(goal, now.agent, now.config.action);
      return SessionVerdict::kClimbing;
    }
    if (policy::FlightContinues(session, now.world.stairs, now.world.map, now.agent.p_world,
                                now.config.policy.stair))
      return SessionVerdict::kClimbing;
    EndSession(now, true);
    return SessionVerdict::kLandingReached;
  }
  const bool is_lost =
      goal.paper.steps_without_stair_target > 14;  // chosen: one look around and a bit
  if (status != policy::SessionStatus::kStalled && !is_lost) return SessionVerdict::kClimbing;
  EndSession(now, false);
  return SessionVerdict::kFailed;
}

std::optional<Action> Explore(Situation& now, const Target& target) {
  GoalState& goal = now.goal;
  const CandidateKind kind = target.candidate.kind;
  const bool is_frontier = kind == CandidateKind::kTraversableFrontier;
  const double arrival_m =
      is_frontier ? now.config.policy.frontier.arrival_m : now.config.policy.stair.arrival_m;
  if (DistanceToGoal(now, target) > arrival_m) {
    goal.paper.commitment->arrived_looks = 0;
    return FollowPath(now, target);
  }
  const Vector3d p_focus = LocalFocus(now, target.candidate);
  if (!is_frontier) {
    goal.paper.entrance = EntranceCheck{kind, p_focus, 0, 0};
    goal.events.push_back("at a stair entrance");
    std::optional<Action> look;
    CheckEntrance(now, &look);
    return look;
  }
  if (auto look =
          CenteringAction(now.eye, p_focus, now.config.sensor.camera_height_m, now.config.action);
      look && goal.paper.commitment->arrived_looks < 8)
    return ++goal.paper.commitment->arrived_looks, look;
  if (goal.paper.commitment->arrived_looks < 8 + kLooksAtFrontier) {
    goal.paper.commitment->arrived_looks += 8;
    if (auto step = FollowPath(now, target)) return step;
  }
  goal.paper.frontier_blacklist.push_back(
      {p_focus, kFrontierBlacklist_m, now.config.policy.poi.blacklist_z_m});
  goal.paper.commitment.reset();
  return Action::kTurnLeft;
}

std::optional<Action> Climb(Situation& now, const std::optional<Target>& target) {
  GoalState& goal = now.goal;
  if (!goal.paper.script.empty()) {
    const Action next = goal.paper.script.front();
    goal.paper.script.pop_front();
    return next;
  }
  const double wanted_pitch =
      goal.paper.session->direction > 0 ? 0 : -DegToRad(now.config.action.pitch_deg);
  if (target) {
    goal.paper.steps_without_stair_target = 0;
    if (auto action = FollowPath(now, *target, wanted_pitch)) return action;
  }
  if (goal.paper.steps_without_stair_target++ == 0)
    QueueLookAround(goal, now.agent, now.config.action);
  return Action::kTurnLeft;
}

std::optional<Action> VisitHistoryPoi(Situation& now, const Target& target) {
  HistoryPoi& poi = now.goal.history[static_cast<std::size_t>(now.goal.paper.active_history)];
  if (DistanceToGoal(now, target) > kArrived_m && poi.looked == 0) {
    if (auto action = FollowPath(now, target)) return action;
  }
  const Vector3d p_aim = policy::AimPoint(poi.voxels, now.agent.p_world, now.config.map.voxel_m);
  if (poi.looked < 8) {
    if (auto look =
            CenteringAction(now.eye, p_aim, now.config.sensor.camera_height_m, now.config.action))
      return ++poi.looked, look;
    poi.looked = 8;
  }
  // Aimed: a wobble to either side gives the detector a few more frames.
  if (const auto wobble = static_cast<std::size_t>(poi.looked - 8); wobble < kWobble.size())
    return ++poi.looked, kWobble[wobble];
  poi.is_exhausted = true;
  const auto& config = now.config.policy.poi;
  now.goal.paper.blacklist.push_back(
      {poi.p_center_world, config.blacklist_xy_m, config.blacklist_z_m});
  now.goal.events.push_back("history POI without success");
  return Action::kTurnLeft;
}

std::optional<Action> Approach(Situation& now, const Target& target, const policy::LivePoi& poi,
                               const policy::Verification& verification) {
  if (verification.passed) return Action::kStop;
  GoalState& goal = now.goal;
  if (DistanceToGoal(now, target) > kArrived_m) {
    if (auto action = FollowPath(now, target)) return action;
  }
  const Vector3d p_aim = policy::AimPoint(poi.voxels, now.agent.p_world, now.config.map.voxel_m);
  if (auto look =
          CenteringAction(now.eye, p_aim, now.config.sensor.camera_height_m, now.config.action))
    return look;
  goal.tried_viewpoints.push_back(now.agent.p_world);
  if (++goal.failed_views >= now.config.policy.approach.max_viewpoints) {
    const auto& config = now.config.policy.poi;
    goal.paper.blacklist.push_back(
        {poi.p_center_world, config.blacklist_xy_m, config.blacklist_z_m});
    goal.live.Discard(poi.id);
    goal.paper.is_detection_rejected = true;
    goal.events.push_back("verification failed: " + verification.failed_check);
  }
  return Action::kTurnLeft;
}

bool LookAroundOnce(Situation& now) {
  GoalState& goal = now.goal;
  if ((goal.p_looked_around_world - now.agent.p_world).norm() < 0.3)
    return false;  // chosen: the same place
  goal.p_looked_around_world = now.agent.p_world;
  goal.paper.script.clear();
  QueueLookAround(goal, now.agent, now.config.action);
  goal.events.push_back("looking around");
  return true;
}

bool Relax(Situation& now) {
  GoalState& goal = now.goal;
  if (goal.paper.is_relaxed) return false;
  goal.paper.is_relaxed = true;
  goal.paper.set_aside.clear();
  goal.paper.frontier_blacklist.clear();
  goal.paper.blacklist.clear();
  goal.live.ForgiveDiscarded();
  goal.tried_viewpoints.clear();
  goal.failed_views = 0;
  Config relaxed = now.config;
  relaxed.query.min_similarity *= 0.8;  // chosen: looser, still a response
  relaxed.query.min_z_score *= 0.6;
  goal.history = RememberedPlaces(now.world, goal, relaxed);
  goal.paper.active_history = -1;
  goal.events.push_back("nothing left: trying once more with relaxed limits");
  return true;
}

}  // namespace crossnav::agent::paper
