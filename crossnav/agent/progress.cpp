// SPDX-License-Identifier: MIT
#include "crossnav/agent/progress.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "crossnav/policy/flights.h"
#include "crossnav/policy/stair_geometry.h"
#include "crossnav/policy/steering.h"

namespace crossnav::agent {

using geometry::VoxelKey;

namespace {

constexpr double kStray_m = 0.6;     // chosen: two steps off the way, and it is planned anew
constexpr double kProgress_m = 0.1;  // chosen: one voxel
constexpr int kMaxReplans = 5;       // chosen: longer ways that what was seen may explain
constexpr double kWalls_m = 1.0;     // chosen: bumps that may wall the agent in

/// Two ways in a row could not be begun from here. Whoever got here is not walled in: the places
/// where it was stopped are wider in the map than they are.
bool IsWalledIn(const Situation& now) {
  const auto& attempts = now.goal.attempts;
  return attempts.size() >= 2 &&
         std::all_of(attempts.end() - 2, attempts.end(), [&](const Attempt& attempt) {
           return attempt.ending == Ending::kNoProgress &&
                  (attempt.p_from_world - now.agent.p_world).norm() < kProgress_m;
         });
}

/// A climb that ended on the way is a try of the flight it was about.
void NoteFlightTry(Situation& now, Ending ending) {
  geometry::FlightTry attempt;
  switch (ending) {
    case Ending::kNotOpened:
      attempt.ending = geometry::TryEnding::kNotOpened;
      break;
    case Ending::kNoProgress:
      attempt.ending = geometry::TryEnding::kNoProgress;
      break;
    case Ending::kUnreachable:
      attempt.ending = geometry::TryEnding::kUnreachable;
      break;
    default:
      return;
  }
  const Vector3d& p_target_world = now.goal.activity.candidate.p_focus_world;
  attempt.p_from_world = now.agent.p_world;
  attempt.is_up = p_target_world.z() > now.world.level_m;
  policy::NoteTry(p_target_world, attempt, &now.world.flights);
}

}  // namespace

void NoteBump(Situation& now) {
  if (!now.world.before_forward) return;
  const AgentPose before = *std::exchange(now.world.before_forward, std::nullopt);
  const Vector3d moved = now.agent.p_world - before.p_world;
  if (moved.head<2>().norm() >= now.config.policy.motion.bump_m) return;
  // What is missing of the step points at what stopped it: a body that slides along a wall has it
  // beside itself, and nothing ahead.
  Vector3d missing =
      now.config.action.forward_m * Vector3d(std::cos(before.yaw_rad), std::sin(before.yaw_rad), 0);
  missing -= Vector3d(moved.x(), moved.y(), 0);
  const Vector3d ahead = missing.normalized(), left(-ahead.y(), ahead.x(), 0);
  const double voxel_m = now.config.map.voxel_m;
  const Vector3d p_contact =
      now.agent.p_world + (now.config.map.agent_radius_m + 0.5 * voxel_m) * ahead;
  // Where that is known already, the obstacle is wider than was thought.
  for (double aside_m = 0; aside_m <= 2 * voxel_m; aside_m += voxel_m) {
    const bool is_new = now.world.ground.Block(p_contact + aside_m * left);
    if (now.world.ground.Block(p_contact - aside_m * left) || is_new) break;
  }
  now.goal.activity.motion.clear();
  now.goal.events.push_back("bump");
}

void QueueLookAround(Situation& now) {
  const auto& action = now.config.action;
  GoalState& goal = now.goal;
  goal.script.clear();
  const double down_rad = DegToRad(now.config.policy.motion.travel_pitch_deg);
  if (const auto pitch = policy::PitchTowards(now.agent, down_rad, action))
    goal.script.push_back(*pitch);
  const int turns = static_cast<int>(std::lround(360.0 / action.turn_deg));
  goal.script.insert(goal.script.end(), static_cast<std::size_t>(turns), Action::kTurnLeft);
  goal.p_looked_around_world = now.agent.p_world;
  now.world.looked_around_m.push_back(now.agent.p_world.z());
}

bool QueueGlance(Situation& now, const VoxelKey& start) {
  const auto heading_rad =
      policy::GlanceHeading(now.world.ground, start, now.eye, DegToRad(now.config.sensor.hfov_deg),
                            now.world.looked_along, now.config.policy.explore);
  if (!heading_rad) return false;
  const double off_rad = WrapAngle(*heading_rad - now.eye.yaw_rad);
  const auto turns = std::lround(std::abs(off_rad) / DegToRad(now.config.action.turn_deg));
  if (turns == 0) return false;
  now.goal.script.insert(now.goal.script.end(), static_cast<std::size_t>(turns),
                         off_rad > 0 ? Action::kTurnLeft : Action::kTurnRight);
  now.goal.activity.motion.clear();
  now.goal.events.push_back("a glance at unseen ground");
  return true;
}

void NoteLevel(Situation& now) {
  World& world = now.world;
  const double z_m = now.agent.p_world.z();
  if (!world.has_level) {
    world.has_level = true;
    world.level_m = z_m;
    world.levels_m.push_back(z_m);
    QueueLookAround(now);
    return;
  }
  auto& way = world.way_off_level_world;
  if (std::abs(z_m - world.level_m) < now.config.policy.frontier.level_band_m) {
    world.flat_frames = 1;
    way.assign(1, now.agent.p_world);
    return;
  }
  if (way.empty() || (way.back() - now.agent.p_world).norm() > 0.5 * now.config.map.voxel_m)
    way.push_back(now.agent.p_world);
  const bool is_flat = policy::IsFlatAround(world.map, now.agent.p_world);
  world.flat_frames = is_flat ? world.flat_frames + 1 : 0;
  if (world.flat_frames < now.config.policy.stair.landing_frames) return;
  world.last_direction = z_m > world.level_m ? 1 : -1;
  now.goal.events.push_back(world.last_direction > 0 ? "new level above" : "new level below");
  if (way.size() > 1) {
    const auto& flight =
        policy::NoteWalk(way, world.stairs, now.config.map.voxel_m, &world.flights);
    world.map.MarkStair(policy::EvidenceOn(flight, world.stairs, now.config.map.voxel_m),
                        geometry::StairMark::kStair);
    const int walks = flight.walked_up + flight.walked_down;
    now.goal.events.push_back(walks == 1 ? "a flight is known" : "a known flight was walked again");
  }
  way.assign(1, now.agent.p_world);
  world.level_m = z_m;
  world.levels_m.push_back(z_m);
  const bool is_known =
      std::any_of(world.looked_around_m.begin(), world.looked_around_m.end(), [&](double looked_m) {
        return std::abs(z_m - looked_m) < now.config.policy.explore.storey_m;
      });
  if (!is_known) QueueLookAround(now);
}

void End(Situation& now, Ending ending) {
  Activity& activity = now.goal.activity;
  if (activity.kind == ActivityKind::kNone) return;
  now.goal.attempts.push_back({activity.candidate.kind, activity.candidate.p_focus_world,
                               now.agent.p_world, ending, now.world.step});
  if (ending != Ending::kSuperseded && ending != Ending::kGone)
    now.goal.events.push_back(std::string(NameOf(activity.kind)) + ": " +
                              std::string(NameOf(ending)));
  if (activity.kind == ActivityKind::kClimb) NoteFlightTry(now, ending);
  activity = Activity{};
  if (IsWalledIn(now) && now.world.ground.ForgetBlockedAround(now.agent.p_world, kWalls_m))
    now.goal.events.push_back("walled in by bumps: they are forgotten here");
}

double RemainingOf(const Situation& now, const std::vector<VoxelKey>& path) {
  const double voxel_m = now.config.map.voxel_m;
  double rest_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    rest_m += voxel_m * geometry::VoxelDistance(path[i - 1], path[i]);
  if (path.empty()) return 0;
  return rest_m + (CenterOf(path.front(), voxel_m) - now.agent.p_world).head<2>().norm();
}

void Begin(Situation& now, ActivityKind kind, GroundTarget target) {
  Activity& activity = now.goal.activity;
  const bool is_same = activity.kind == kind && activity.candidate.kind == target.candidate.kind &&
                       activity.candidate.id == target.candidate.id &&
                       (activity.candidate.p_focus_world - target.candidate.p_focus_world).norm() <=
                           now.config.policy.explore.same_place_m;
  if (!is_same) {
    End(now, Ending::kSuperseded);
    activity.kind = kind;
  }
  const double rest_m = RemainingOf(now, target.path);
  if (!is_same || rest_m < activity.best_m) {
    activity.best_m = rest_m;
    activity.idle_steps = 0;
  } else if (activity.is_path_closed && activity.replans < kMaxReplans) {
    // What was seen since made the way longer: that is no lack of progress.
    ++activity.replans;
    activity.best_m = rest_m;
  }
  if (target.path != activity.path) activity.motion.clear();
  activity.candidate = std::move(target.candidate);
  activity.path = std::move(target.path);
  activity.ground_revision = now.world.ground.revision();
  activity.is_path_closed = false;
}

bool KeepToPath(Situation& now) {
  Activity& activity = now.goal.activity;
  const double voxel_m = now.config.map.voxel_m;
  std::size_t nearest = 0;
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < std::min<std::size_t>(activity.path.size(), 30); ++i) {
    const double d = (CenterOf(activity.path[i], voxel_m) - now.agent.p_world).head<2>().norm();
    if (d > nearest_m) continue;
    nearest = i;
    nearest_m = d;
  }
  if (nearest_m > kStray_m) return false;
  activity.path.erase(activity.path.begin(),
                      activity.path.begin() + static_cast<std::ptrdiff_t>(nearest));
  const auto& ground = now.world.ground;
  if (activity.ground_revision == ground.revision()) return true;
  for (std::size_t i = 1; i < activity.path.size(); ++i) {
    const VoxelKey &from = activity.path[i - 1], &to = activity.path[i];
    int z = 0;
    if (ground.SideOf(from, to.x - from.x, to.y - from.y, &z) != planner::Side::kGround ||
        z != to.z) {
      activity.is_path_closed = true;
      return false;
    }
  }
  activity.ground_revision = ground.revision();
  return true;
}

void MeasureProgress(Situation& now) {
  Activity& activity = now.goal.activity;
  if (activity.kind == ActivityKind::kNone) return;
  ++activity.steps;
  const double rest_m = RemainingOf(now, activity.path);
  if (rest_m < activity.best_m - kProgress_m) {
    activity.best_m = rest_m;
    activity.idle_steps = 0;
    return;
  }
  ++activity.idle_steps;
  const auto& explore = now.config.policy.explore;
  const bool is_bounded =
      activity.kind == ActivityKind::kApproach || activity.kind == ActivityKind::kVisit;
  const int allowed = is_bounded ? 2 * explore.progress_steps : explore.progress_steps;
  if (activity.idle_steps <= allowed) return;
  if (activity.kind == ActivityKind::kVisit)
    now.goal.history[static_cast<std::size_t>(activity.candidate.id)].is_exhausted = true;
  if (activity.kind == ActivityKind::kApproach) now.goal.live.Discard(activity.candidate.id);
  End(now, Ending::kNoProgress);
}

double DistanceToEnd(const Situation& now) {
  const Activity& activity = now.goal.activity;
  if (activity.path.empty()) return 0;
  const Vector3d p = CenterOf(activity.path.back(), now.config.map.voxel_m);
  return (p - now.agent.p_world).head<2>().norm();
}

}  // namespace crossnav::agent
