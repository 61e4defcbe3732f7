// SPDX-License-Identifier: MIT
#include "crossnav/agent/pursuit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "crossnav/agent/claims.h"
#include "crossnav/agent/scan.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/policy/flights.h"

namespace crossnav::agent {

using geometry::VoxelKey;

namespace {

constexpr double kStray_m = 0.6;           // chosen: two steps off the path
constexpr std::size_t kStrayPlaces = 30;   // chosen: front of the path that is compared
constexpr double kProgress_m = 0.1;        // chosen: one voxel
constexpr int kMaxReplans = 5;             // chosen: longer paths that observations explain
constexpr double kGapAhead_m = 1.0;        // chosen: a gap that the body had begun to try
constexpr double kWalledInRadius_m = 1.0;  // chosen: bumps that may wall the agent in
constexpr std::size_t kMostStuck = 3;      // chosen: approaches without progress to one object

/// Marks were forgotten here before, and the same headings failed again.
bool WasUnmarkedHere(const StepState& now) {
  const auto& p_world = now.goal.full.p_unmarked_world;
  return p_world && (*p_world - now.agent.p_world).norm() < kProgress_m;
}

/// Two pursuits in a row made no progress from the same place. An agent that reached the place is
/// not walled in: marks of bumps are wider in the map than the obstacles.
bool IsWalledIn(const StepState& now) {
  const auto& attempts = now.goal.full.attempts;
  return attempts.size() >= 2 &&
         std::all_of(attempts.end() - 2, attempts.end(), [&](const Attempt& attempt) {
           return attempt.ending == Ending::kNoProgress &&
                  (attempt.p_from_world - now.agent.p_world).norm() < kProgress_m;
         });
}

std::optional<geometry::TryEnding> TryEndingOf(Ending ending) {
  switch (ending) {
    case Ending::kNotOpened:
      return geometry::TryEnding::kNotOpened;
    case Ending::kNoProgress:
      return geometry::TryEnding::kNoProgress;
    case Ending::kUnreachable:
      return geometry::TryEnding::kUnreachable;
    default:
      return std::nullopt;
  }
}

/// Records a climb that ended short of its target at the flight.
void NoteFlightTry(StepState& now, const policy::Candidate& target, Ending ending) {
  const auto try_ending = TryEndingOf(ending);
  if (!try_ending) return;
  geometry::FlightTry attempt;
  attempt.ending = *try_ending;
  attempt.p_from_world = now.agent.p_world;
  attempt.is_up = target.p_focus_world.z() > now.world.level_m;
  policy::NoteTry(target.p_focus_world, attempt, &now.world.flights);
}

/// The first narrow place of the path is closed: the body tried it in vain, so that places behind
/// it do not count.
void CloseGap(StepState& now, const Route& route) {
  const double voxel_m = now.config.map.voxel_m;
  for (const VoxelKey& key : route.path) {
    const Vector3d p_world = CenterOf(key, voxel_m);
    if ((p_world - now.agent.p_world).head<2>().norm() > kGapAhead_m) return;
    if (now.world.ground.ClearanceOf(key) != planner::Clearance::kPinch) continue;
    now.world.ground.Block(p_world);
    return;
  }
}

bool HaveSameTarget(const Pursuit& a, const Pursuit& b, double same_place_m) {
  if (a.index() != b.index()) return false;
  const Pursued *x = PursuedIn(a), *y = PursuedIn(b);
  if (!x || !y || x->target.kind != y->target.kind || x->target.poi_id != y->target.poi_id)
    return false;
  if (const VisitPlace* visit = std::get_if<VisitPlace>(&a);
      visit && visit->place != std::get<VisitPlace>(b).place)
    return false;
  return (x->target.p_focus_world - y->target.p_focus_world).norm() <= same_place_m;
}

/// Carries the progress along `old` over to `fresh`, a new path to the same target.
void ContinueRoute(const Route& old, double rest_m, Route* fresh) {
  std::vector<VoxelKey> path = std::exchange(fresh->path, {});
  const bool is_same_path = path == old.path;
  *fresh = old;
  fresh->path = std::move(path);
  if (!is_same_path) fresh->motion.clear();
  if (rest_m < fresh->best_m) {
    fresh->best_m = rest_m;
    fresh->idle_steps = 0;
  } else if (fresh->is_closed && fresh->replans < kMaxReplans) {
    // An observation that makes the path longer is no lack of progress.
    ++fresh->replans;
    fresh->best_m = rest_m;
  }
}

}  // namespace

void Begin(StepState& now, Pursuit pursuit) {
  Pursued* fresh = PursuedIn(pursuit);
  if (!fresh) return;
  const double rest_m = RemainingOf(now, fresh->route.path);
  const Pursuit& current = PursuitOf(now.goal.full.activity);
  if (HaveSameTarget(current, pursuit, now.config.policy.explore.same_place_m)) {
    const Pursued* old = PursuedIn(current);
    fresh->looks = old->looks;
    ContinueRoute(old->route, rest_m, &fresh->route);
  } else {
    End(now, Ending::kSuperseded);
    fresh->route.best_m = rest_m;
  }
  fresh->route.ground_revision = now.world.ground.revision();
  fresh->route.is_closed = false;
  PursuitOf(now.goal.full.activity) = std::move(pursuit);
}

void End(StepState& now, Ending ending) {
  Pursuit& pursuit = PursuitOf(now.goal.full.activity);
  const Pursued* pursued = PursuedIn(pursuit);
  if (!pursued) return;
  now.goal.full.attempts.push_back({pursued->target.kind, pursued->target.p_focus_world,
                                    now.agent.p_world, ending, now.world.step});
  if (ending != Ending::kSuperseded && ending != Ending::kGone)
    now.goal.events.push_back(std::string(NameOf(pursuit)) + ": " + std::string(NameOf(ending)));
  if (std::holds_alternative<Climb>(pursuit)) NoteFlightTry(now, pursued->target, ending);
  if (const Approach* approach = std::get_if<Approach>(&pursuit);
      approach && TryEndingOf(ending) && now.goal.full.claims.second_view_of == approach->poi_id)
    GiveUpSecondView(now, approach->poi_id);
  if (ending == Ending::kNoProgress && now.goal.full.may_squeeze) CloseGap(now, pursued->route);
  pursuit = Idle{};
  if (!IsWalledIn(now)) return;
  if (!now.goal.full.may_squeeze && !WasUnmarkedHere(now) &&
      now.world.ground.ForgetBlockedAround(now.agent.p_world, kWalledInRadius_m)) {
    now.goal.full.p_unmarked_world = now.agent.p_world;
    now.goal.events.push_back("walled in by bumps: they are forgotten here");
  } else if (!IsScanning(now.goal.full.activity)) {
    BeginEscape(now);
    now.goal.events.push_back("walled in: a step is tried in every heading");
  }
}

double RemainingOf(const Situation& now, const std::vector<VoxelKey>& path) {
  const double voxel_m = now.config.map.voxel_m;
  double rest_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    rest_m += voxel_m * geometry::VoxelDistance(path[i - 1], path[i]);
  if (path.empty()) return 0;
  return rest_m + (CenterOf(path.front(), voxel_m) - now.agent.p_world).head<2>().norm();
}

PathCheck CheckPath(const Situation& now) {
  PathCheck check;
  const Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity));
  if (!pursued) return check;
  const Route& route = pursued->route;
  const double voxel_m = now.config.map.voxel_m;
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < std::min(route.path.size(), kStrayPlaces); ++i) {
    const Vector3d off = CenterOf(route.path[i], voxel_m) - now.agent.p_world;
    // A flight below or above the agent may be a part of the same path.
    const double d = off.head<2>().norm();
    if (d > nearest_m || std::abs(off.z()) > kStray_m) continue;
    check.walked = i;
    nearest_m = d;
  }
  check.is_near = nearest_m <= kStray_m;
  const auto& ground = now.world.ground;
  if (!check.is_near || route.ground_revision == ground.revision()) return check;
  for (std::size_t i = check.walked + 1; i < route.path.size() && !check.is_closed; ++i) {
    const VoxelKey &from = route.path[i - 1], &to = route.path[i];
    int z = 0;
    check.is_closed =
        ground.OutcomeOf(from, to.x - from.x, to.y - from.y, &z) != planner::StepOutcome::kGround ||
        z != to.z;
  }
  return check;
}

void UpdatePath(StepState& now, const PathCheck& check) {
  Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity));
  if (!pursued || !check.is_near) return;
  Route& route = pursued->route;
  route.path.erase(route.path.begin(),
                   route.path.begin() + static_cast<std::ptrdiff_t>(check.walked));
  if (check.is_closed)
    route.is_closed = true;
  else
    route.ground_revision = now.world.ground.revision();
}

void MeasureProgress(StepState& now) {
  const Pursuit& pursuit = PursuitOf(now.goal.full.activity);
  Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity));
  if (!pursued) return;
  Route& route = pursued->route;
  ++route.steps;
  const double rest_m = RemainingOf(now, route.path);
  if (rest_m < route.best_m - kProgress_m) {
    route.best_m = rest_m;
    route.idle_steps = 0;
    return;
  }
  ++route.idle_steps;
  const auto& explore = now.config.policy.explore;
  const int allowed = IsExploring(pursuit) ? explore.progress_steps : 2 * explore.progress_steps;
  if (route.idle_steps <= allowed) return;
  if (const VisitPlace* visit = std::get_if<VisitPlace>(&pursuit)) {
    HistoryPoi& place = now.goal.history[static_cast<std::size_t>(visit->place)];
    // Nobody has seen that it is empty.
    if (now.world.revision)
      place.unreachable_step = now.world.step;
    else
      place.is_exhausted = true;
  }
  // A claim that only lacks its second view stays: the agent returns to the first view.
  const policy::ClaimTracker& claims = now.goal.full.claims;
  if (const Approach* approach = std::get_if<Approach>(&pursuit);
      approach &&
      (claims.second_view_of != approach->poi_id || claims.no_second_view_of == approach->poi_id) &&
      StuckApproaches(now, approach->target.p_focus_world).size() + 1 >= kMostStuck)
    now.goal.live.Discard(approach->poi_id);
  End(now, Ending::kNoProgress);
}

std::vector<Vector3d> StuckApproaches(const Situation& now, const Vector3d& p_object_world) {
  std::vector<Vector3d> p_from_world;
  for (const Attempt& attempt : now.goal.full.attempts)
    if (attempt.kind == policy::CandidateKind::kLivePoi && attempt.ending == Ending::kNoProgress &&
        (attempt.p_focus_world - p_object_world).norm() <= now.config.policy.poi.blacklist_xy_m)
      p_from_world.push_back(attempt.p_from_world);
  return p_from_world;
}

double DistanceToEnd(const Situation& now) {
  const Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity));
  if (!pursued || pursued->route.path.empty()) return 0;
  return DistanceToEndOf(pursued->route.path, now.agent.p_world, now.config.map.voxel_m);
}

}  // namespace crossnav::agent
