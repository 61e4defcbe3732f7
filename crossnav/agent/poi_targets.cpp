// SPDX-License-Identifier: MIT
#include "crossnav/agent/poi_targets.h"

#include <algorithm>
#include <cmath>

#include "crossnav/agent/claims.h"
#include "crossnav/agent/pursuit.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/agent/whereabouts.h"
#include "crossnav/policy/approach.h"
#include "crossnav/policy/frontiers.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using planner::GroundSearch;
using policy::Candidate;
using policy::CandidateKind;

namespace {

constexpr double kSlack_m = 0.1;      // chosen: the agent stops that near to where it was sent
constexpr double kUnderFoot_m = 0.5;  // chosen: lower voxels belong to another storey
constexpr double kFloorShare = 0.25;  // chosen: of the most places at one height; treads have less
constexpr double kStandBeside_m = 0.6;  // chosen: a robot and a step from the object
constexpr double kOverGround_m = 0.35;  // chosen: a sill or a step, and a voxel
constexpr double kStuck_m = 0.5;        // chosen: two steps from where an approach was stuck
// chosen: of the angle of one side; first near the view itself
constexpr double kSideShares[] = {0.5, 1};
constexpr double kBestShare = 0.6;  // chosen: of the best score, remembered places that count alike
constexpr double kStandsOut = 0.4;  // chosen: of poi.similarity_slack, above any other place

bool IsNearTried(const std::vector<Vector3d>& tried, const Vector3d& p) {
  return std::any_of(tried.begin(), tried.end(),
                     [&](const Vector3d& t) { return (t - p).norm() < policy::kSameView_m; });
}

template <class Test>
bool IsAnyStanding(const planner::GroundMap& ground, const VoxelKey& lo, const VoxelKey& hi,
                   const Test& test) {
  for (int x = lo.x; x <= hi.x; ++x)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int z = lo.z; z <= hi.z; ++z)
        if (const VoxelKey key{x, y, z}; ground.IsStanding(key) && test(key)) return true;
  return false;
}

template <class Test>
std::optional<GroundTarget> NearestPlace(const Situation& now, const VoxelKey& start,
                                         const Test& is_wanted) {
  GroundSearch search(now.world.ground, now.config.planner, start, RulesOf(now));
  while (const auto key = search.Next()) {
    if (!is_wanted(*key)) continue;
    GroundTarget target;
    target.path = search.PathTo(*key);
    target.cost_m = search.cost() * now.config.map.voxel_m;
    target.candidate.standing = {*key};
    return target;
  }
  return std::nullopt;
}

/// To about where the agent stood before.
std::optional<GroundTarget> WayBackTo(const Situation& now, const VoxelKey& start,
                                      const Vector3d& p_foot_world) {
  return NearestPlace(now, start, [&](const VoxelKey& key) {
    return (FootOf(key, now.config.map.voxel_m) - p_foot_world).norm() < policy::kSameView_m;
  });
}

}  // namespace

Vector3d FootOf(const VoxelKey& key, double voxel_m) {
  return CenterOf(key, voxel_m) - Vector3d(0, 0, 0.5 * voxel_m);
}

bool IsOnStorey(double above_foot_m, const policy::ExploreConfig& config) {
  return above_foot_m >= -kUnderFoot_m && above_foot_m <= config.storey_m;
}

ObjectStorey::ObjectStorey(const Situation& now, const std::vector<VoxelKey>& object,
                           const Vector3d& p_center_world)
    : center_m_(p_center_world.z()), config_(now.config.policy.explore) {
  if (object.empty()) return;
  const double voxel_m = now.config.map.voxel_m;
  const int beside_vox = static_cast<int>(std::lround(kStandBeside_m / voxel_m));
  VoxelKey lo = object.front(), hi = object.front();
  for (const VoxelKey& key : object) {
    lo = {std::min(lo.x, key.x), std::min(lo.y, key.y), 0};
    hi = {std::max(hi.x, key.x), std::max(hi.y, key.y), 0};
  }
  const int top = geometry::KeyOf(p_center_world, voxel_m).z;
  const int bottom = top - static_cast<int>(std::lround(config_.storey_m / voxel_m));
  std::vector<int> places;  // by height, downwards
  for (int z = top; z >= bottom; --z) {
    places.push_back(0);
    for (int x = lo.x - beside_vox; x <= hi.x + beside_vox; ++x)
      for (int y = lo.y - beside_vox; y <= hi.y + beside_vox; ++y)
        places.back() += now.world.ground.IsStanding({x, y, z}) ? 1 : 0;
  }
  const double least = kFloorShare * *std::max_element(places.begin(), places.end());
  const auto floor =
      std::find_if(places.begin(), places.end(), [&](int n) { return n > 0 && n >= least; });
  if (floor != places.end()) ground_m_ = (top - (floor - places.begin())) * voxel_m;
}

bool ObjectStorey::Has(const Vector3d& p_foot_world) const {
  if (!IsOnStorey(center_m_ - p_foot_world.z(), config_)) return false;
  return !ground_m_ || p_foot_world.z() - *ground_m_ <= kOverGround_m;
}

planner::GroundRules RulesOf(const Situation& now) {
  planner::GroundRules rules;
  rules.may_squeeze = now.goal.full.may_squeeze;
  rules.may_step_on_seats = now.goal.full.may_step_on_seats;
  if (now.config.policy.planar) {
    rules.level =
        policy::BandAround(now.world.level_m, now.config.policy.frontier, now.config.map.voxel_m);
  }
  return rules;
}

std::optional<GroundTarget> NearestView(const Situation& now, const VoxelKey& start,
                                        const ViewWish& wish) {
  if (wish.object.empty()) return std::nullopt;
  const planner::GroundMap& ground = now.world.ground;
  const double voxel_m = now.config.map.voxel_m;
  policy::ViewTest view(now.world.map, wish.object, wish.range_m, now.config.policy.approach,
                        now.config.sensor.camera_height_m);
  if (wish.is_through_seen_air) view.AskForSeenAir();
  std::optional<ObjectStorey> storey;
  if (wish.is_on_storey) storey.emplace(now, wish.object, wish.p_center_world);
  policy::VerifyConfig sides = now.config.verify;
  sides.view_angle_deg *= wish.side_share;
  const auto is_wanted = [&](const VoxelKey& key) {
    const Vector3d p_foot = FootOf(key, voxel_m);
    if (storey && !storey->Has(p_foot)) return false;
    if (wish.same_side && IsOtherView(wish.p_center_world, p_foot, *wish.same_side, sides))
      return false;
    return IsNewView(wish.p_center_world, p_foot, wish.other_sides, now.config.verify) &&
           view.IsView(key) && !IsNearTried(wish.tried, p_foot);
  };
  // A search that finds nothing visits the whole house.
  if (!IsAnyStanding(ground, view.lo(), view.hi(), is_wanted)) return std::nullopt;
  return NearestPlace(now, start, is_wanted);
}

FailedViews FailedViewsOf(const GoalState& goal, int poi_id) {
  if (poi_id == goal.active_live)
    return {poi_id, goal.tried_viewpoints, goal.failed_views, goal.full.doubtful_m};
  const auto& all = goal.full.failed;
  const auto it = std::find_if(all.begin(), all.end(),
                               [&](const FailedViews& views) { return views.poi_id == poi_id; });
  return it == all.end() ? FailedViews{poi_id, {}, 0, 0} : *it;
}

std::optional<GroundTarget> ViewOf(const Situation& now, const VoxelKey& start,
                                   const policy::LivePoi& poi) {
  const FailedViews failed = FailedViewsOf(now.goal, poi.id);
  ViewWish wish{poi.voxels,          now.config.policy.approach.range_m - kSlack_m,
                failed.p_from_world, ViewsToAvoid(now, poi),
                poi.p_center_world,  true};
  if (failed.doubtful_m > 0)
    for (const double share : kNearerShares) {
      ViewWish nearer = wish;
      nearer.range_m = std::min(wish.range_m, share * failed.doubtful_m);
      if (auto target = NearestView(now, start, nearer)) return target;
    }
  wish.same_side = ViewToReturnTo(now, poi.id);
  for (const double share : kSideShares) {
    if (!wish.same_side) break;
    wish.side_share = share;
    if (auto target = NearestView(now, start, wish)) return target;
  }
  wish.same_side.reset();
  if (auto target = NearestView(now, start, wish)) return target;
  const policy::SettledObject* settled = now.goal.full.claims.SettledFor(poi.id);
  if (!settled || IsNearTried(wish.tried, settled->p_foot_world)) return std::nullopt;
  return WayBackTo(now, start, settled->p_foot_world);
}

namespace {

/// An approach made no progress from about here; from elsewhere another way may lead there. A claim
/// without a second view goes back to the first.
bool WasStuckHere(const Situation& now, const policy::LivePoi& poi) {
  if (now.goal.full.claims.no_second_view_of == poi.id) return false;
  const auto stuck = StuckApproaches(now, poi.p_center_world);
  return std::any_of(stuck.begin(), stuck.end(), [&](const Vector3d& p_from_world) {
    return (p_from_world - now.agent.p_world).norm() < kStuck_m;
  });
}

}  // namespace

std::optional<GroundTarget> ChooseLivePoi(const Situation& now, const VoxelKey& start) {
  for (const policy::LivePoi* poi : now.goal.live.Stable(now.config.policy.object)) {
    if (WasStuckHere(now, *poi)) continue;
    auto target = ViewOf(now, start, *poi);
    if (!target) continue;
    auto standing = std::move(target->candidate.standing);
    target->candidate = CandidateOf(*poi);
    target->candidate.standing = std::move(standing);
    return target;
  }
  return std::nullopt;
}

namespace {

/// Whether no other place of the memory answers nearly as well, and no other thing is known there.
/// A place that answers weakly, and no better than others, is a thing that is like the goal.
bool StandsOut(const Situation& now, const HistoryPoi& poi) {
  const auto& history = now.goal.history;
  const double least = poi.similarity - kStandsOut * now.config.policy.poi.similarity_slack;
  return std::all_of(history.begin(), history.end(),
                     [&](const HistoryPoi& other) {
                       return &other == &poi || other.similarity <= least;
                     }) &&
         !IsAnotherThing(now.world, now.goal, poi);
}

bool AnswersWeakly(const Situation& now, const HistoryPoi& poi) {
  return poi.similarity <
         now.world.full.confirmed_similarity - now.config.policy.poi.similarity_slack;
}

bool IsGoingToClosedWay(const Situation& now) {
  const Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity));
  return pursued && pursued->target.kind == CandidateKind::kClosedWay;
}

/// Not exhausted, like enough to the goal, not tried too often, and not searched in vain of late.
bool IsWorthGoingTo(const Situation& now, const HistoryPoi& poi,
                    std::optional<int> unreachable_step, double least_score) {
  const auto& policy = now.config.policy;
  if (poi.is_exhausted || poi.score < least_score) return false;
  // A search in vain visits the whole house, and a step does not open it, but towards a shut door.
  const int patience = IsGoingToClosedWay(now) ? 1 : policy.explore.reconsider_steps;
  if (unreachable_step && now.world.step - *unreachable_step < patience) return false;
  if (AnswersWeakly(now, poi) && now.goal.full.last_resorts == 0 && !StandsOut(now, poi))
    return false;
  // A repeated query returns the same places: visited places are settled.
  return !IsSpent(now.goal.full.attempts, CandidateKind::kHistoryPoi, poi.p_center_world,
                  policy.poi.blacklist_xy_m, policy.explore.max_choices);
}

/// Where to look at the place from, from farther away if need be. It has been seen: a view through
/// seen air exists as a rule, while the nearest place may lie behind a wall that was not seen.
std::optional<GroundTarget> ViewOf(const Situation& now, const VoxelKey& start,
                                   const HistoryPoi& poi) {
  const double range_m = now.config.policy.approach.range_m;
  ViewWish wish{poi.voxels, 0, {}, poi.p_looked_world, poi.p_center_world, true};
  for (const bool is_through_seen_air : {true, false})
    for (const double within_m : {range_m - kSlack_m, 2 * range_m}) {
      wish.range_m = within_m;
      wish.is_through_seen_air = is_through_seen_air;
      if (auto target = NearestView(now, start, wish)) return target;
    }
  return std::nullopt;
}

}  // namespace

bool HasOtherSide(const Situation& now, const HistoryPoi& poi) {
  const bool is_on_record = IsBelieved(now.world, now.goal, poi);
  if (!is_on_record && (AnswersWeakly(now, poi) || HasRecord(now.world, now.goal))) return false;
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  return start && ViewOf(now, *start, poi);
}

bool IsWorthGoingTo(const Situation& now, const HistoryPoi& poi) {
  return IsWorthGoingTo(now, poi, std::nullopt, 0);
}

bool IsToBeVisited(const Situation& now, const HistoryPoi& poi) {
  return !poi.unreachable_step && IsWorthGoingTo(now, poi);
}

PlaceChoice ChooseHistoryPoi(const Situation& now, const VoxelKey& start) {
  PlaceChoice choice;
  double best_score = 0;
  for (const HistoryPoi& poi : now.goal.history) {
    choice.unreachable_steps.push_back(poi.unreachable_step);
    if (!poi.is_exhausted) best_score = std::max(best_score, poi.score);
  }
  // Among places that answer about equally well the least path for its probability; then the
  // others.
  for (const double share : {kBestShare, 0.0}) {
    for (std::size_t i = 0; i < now.goal.history.size(); ++i) {
      const HistoryPoi& poi = now.goal.history[i];
      std::optional<int>& unreachable_step = choice.unreachable_steps[i];
      if (!IsWorthGoingTo(now, poi, unreachable_step, share * best_score)) continue;
      auto target = ViewOf(now, start, poi);
      unreachable_step = target ? std::nullopt : std::optional(now.world.step);
      if (!target) continue;
      target->score_m = (target->cost_m + now.config.policy.explore.start_m) / poi.belief;
      if (choice.target && choice.target->score_m <= target->score_m) continue;
      auto standing = std::move(target->candidate.standing);
      target->candidate = CandidateOf(poi);
      target->candidate.standing = std::move(standing);
      choice.place = static_cast<int>(i);
      choice.target = std::move(target);
    }
    if (choice.target) break;
  }
  return choice;
}

}  // namespace crossnav::agent
