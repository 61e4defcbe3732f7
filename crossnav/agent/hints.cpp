// SPDX-License-Identifier: MIT
#include "crossnav/agent/hints.h"

#include <algorithm>
#include <cmath>

#include "crossnav/agent/claims.h"
#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using policy::CandidateKind;

namespace {

constexpr double kRise = 0.01;  // chosen: of the confidence; less is noise

bool WasApproached(const Situation& now, const policy::LivePoi& poi) {
  return std::any_of(now.goal.full.attempts.begin(), now.goal.full.attempts.end(),
                     [&](const Attempt& tried) {
                       return tried.kind == CandidateKind::kLivePoi &&
                              (tried.p_focus_world - poi.p_center_world).norm() <
                                  now.config.policy.explore.same_place_m;
                     });
}

const CloseLooks* FindLooks(const std::vector<CloseLooks>& all, int poi_id) {
  const auto it = std::find_if(all.begin(), all.end(),
                               [&](const CloseLooks& looks) { return looks.poi_id == poi_id; });
  return it == all.end() ? nullptr : &*it;
}

bool WasLookedFrom(const CloseLooks* looks, const Vector3d& p_foot_world) {
  return looks && std::any_of(looks->p_from_world.begin(), looks->p_from_world.end(),
                              [&](const Vector3d& p_from_world) {
                                return (p_from_world - p_foot_world).norm() < policy::kSameView_m;
                              });
}

}  // namespace

bool NoteLook(StepState& now, int poi_id) {
  const policy::LivePoi* poi = now.goal.full.hints.Find(poi_id);
  if (!poi) return true;
  std::vector<CloseLooks>& all = now.goal.full.looks;
  if (!FindLooks(all, poi_id)) all.push_back({poi_id, {}, 0, 0, 0});
  CloseLooks& looks = *std::find_if(
      all.begin(), all.end(), [&](const CloseLooks& known) { return known.poi_id == poi_id; });
  const bool has_risen = poi->confidence > looks.confidence + kRise;
  looks.without_rise = has_risen ? 0 : looks.without_rise + 1;
  looks.confidence = poi->confidence;
  looks.p_from_world.push_back(now.agent.p_world);
  if (has_risen)
    looks.distance_m =
        policy::DistanceToObject(poi->voxels, now.agent.p_world, now.config.sensor.camera_height_m,
                                 now.config.map.voxel_m, /*stray_share=*/0);
  const int enough = IsUnlikelyHint(now, *poi) ? 1 : now.config.policy.approach.max_viewpoints;
  return looks.without_rise >= enough;
}

bool IsSeenFromReach(const Situation& now, int poi_id) {
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  if (!start) return true;  // nothing is known
  Hints hints(now);
  planner::GroundSearch search(now.world.ground, now.config.planner, *start, RulesOf(now));
  while (const auto place = search.Next())
    for (const Hints::View& view : hints.SeenFrom(*place))
      if (view.candidate.poi_id == poi_id) return true;
  return false;
}

Hints::Hints(const Situation& now) : now_(now) {
  const policy::PolicyConfig& config = now.config.policy;
  for (const policy::LivePoi& poi : now.goal.full.hints.all()) {
    if (poi.is_discarded || IsHopelessHint(now, poi) ||
        IsSpent(now.goal.full.attempts, CandidateKind::kSighting, poi.p_center_world,
                config.explore.same_place_m, config.explore.max_choices))
      continue;
    const CloseLooks* looks = FindLooks(now.goal.full.looks, poi.id);
    hints_.push_back({poi, ViewWithin(config.approach.range_m, poi), NearerView(poi, looks), looks,
                      WasApproached(now, poi)});
  }
}

policy::ViewTest Hints::ViewWithin(double range_m, const policy::LivePoi& poi) const {
  return {now_.world.map, poi.voxels, range_m, now_.config.policy.approach,
          now_.config.sensor.camera_height_m};
}

/// Test for the nearer view that is due after the last view.
std::optional<policy::ViewTest> Hints::NearerView(const policy::LivePoi& poi,
                                                  const CloseLooks* looks) const {
  if (!looks || looks->distance_m <= 0) return std::nullopt;
  for (const double share : kNearerShares) {
    policy::ViewTest view =
        ViewWithin(std::min(now_.config.policy.approach.range_m, share * looks->distance_m), poi);
    if (HasView(view, looks)) return view;
  }
  return std::nullopt;
}

/// Whether a place with such a view exists, reachable or not.
bool Hints::HasView(const policy::ViewTest& view, const CloseLooks* looks) const {
  const VoxelKey &lo = view.lo(), &hi = view.hi();
  for (int x = lo.x; x <= hi.x; ++x)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int z = lo.z; z <= hi.z; ++z)
        if (const VoxelKey key{x, y, z}; now_.world.ground.IsStanding(key) &&
                                         !WasLookedFrom(looks, FootOf(key, voxel_m())) &&
                                         view.IsView(key))
          return true;
  return false;
}

std::vector<Hints::View> Hints::SeenFrom(const VoxelKey& key) {
  std::vector<View> seen;
  for (Hint& hint : hints_) {
    if (hint.is_seen_nearer || WasLookedFrom(hint.looks, FootOf(key, voxel_m()))) continue;
    const bool is_nearer = hint.nearer && hint.nearer->IsView(key);
    if (!is_nearer && (hint.is_seen || !hint.view.IsView(key))) continue;
    hint.is_seen = true;
    hint.is_seen_nearer = is_nearer || !hint.nearer;
    View view;
    view.is_nearer = hint.is_seen_nearer;
    view.candidate.kind = CandidateKind::kSighting;
    view.candidate.poi_id = hint.poi.id;
    view.candidate.p_focus_world = hint.poi.p_center_world;
    view.candidate.standing = {key};
    view.candidate.size = static_cast<int>(hint.poi.voxels.size());
    seen.push_back(std::move(view));
  }
  return seen;
}

std::optional<double> Hints::StraightTo(const VoxelKey& key) const {
  std::optional<double> least_m;
  for (const Hint& hint : hints_) {
    const Vector3d d = hint.poi.p_center_world - CenterOf(key, now_.config.map.voxel_m);
    if (hint.is_seen || hint.was_approached || !IsOnStorey(d.z(), now_.config.policy.explore))
      continue;
    least_m = std::min(least_m.value_or(1e9), std::hypot(d.x(), d.y()));
  }
  return least_m;
}

}  // namespace crossnav::agent
