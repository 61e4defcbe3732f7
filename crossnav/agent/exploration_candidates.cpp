// SPDX-License-Identifier: MIT
#include "crossnav/agent/exploration_candidates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/agent/explore.h"
#include "crossnav/policy/flights.h"
#include "crossnav/policy/ground_frontiers.h"
#include "crossnav/policy/stair_geometry.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using policy::Candidate;
using policy::CandidateKind;

namespace {

/// Whether the target was tried in vain. A frontier is the same on whatever level it counts.
bool WasTried(const Situation& now, CandidateKind kind, const Vector3d& p_focus_world) {
  const auto& explore = now.config.policy.explore;
  const auto is_spent = [&](CandidateKind tried) {
    return IsSpent(now.goal.full.attempts, tried, p_focus_world, explore.same_place_m,
                   explore.max_choices);
  };
  if (!policy::IsFrontier(kind)) return is_spent(kind);
  return is_spent(CandidateKind::kTraversableFrontier) || is_spent(CandidateKind::kStairFrontier);
}

/// Below every level that was stood on.
bool IsBelowAllLevels(const World& world, double z_m) {
  return std::all_of(world.levels_m.begin(), world.levels_m.end(),
                     [&](double level_m) { return z_m < level_m; });
}

/// Whether the place is a tread of a flight that was not walked yet: with stair evidence, or below
/// the lowest level (no furniture is stepped down to from a floor), or farther from every level
/// than furniture is high.
bool LeadsToStorey(const Situation& now, const VoxelKey& place) {
  const World& world = now.world;
  const double voxel_m = now.config.map.voxel_m;
  const Vector3d p_world = CenterOf(place, voxel_m);
  for (const geometry::StairFlight& flight : world.flights)
    if (flight.IsWalked() && policy::IsBeside(flight, p_world)) return false;
  if (policy::EvidenceShare({p_world}, world.stairs, voxel_m) > 0) return true;
  if (RiseOf(now, place) < -1.5 * voxel_m && IsBelowAllLevels(world, p_world.z())) return true;
  return std::all_of(world.levels_m.begin(), world.levels_m.end(), [&](double level_m) {
    return std::abs(p_world.z() - level_m) >= now.config.policy.explore.furniture_m;
  });
}

/// Two steps, or a step of double height, within the depth of a tread.
bool IsBesideStep(const planner::GroundMap& ground, const VoxelKey& place) {
  constexpr int kTread_vox = 3, kRiser_vox = 2;  // chosen: depth and height of a tread
  for (int dx = -kTread_vox; dx <= kTread_vox; ++dx)
    for (int dy = -kTread_vox; dy <= kTread_vox; ++dy) {
      const auto z = ground.StandingNear(place.x + dx, place.y + dy, place.z, ground.climb());
      if (z && std::abs(*z - place.z) >= kRiser_vox) return true;
    }
  return false;
}

}  // namespace

double RiseOf(const Situation& now, const VoxelKey& place) {
  const double voxel_m = now.config.map.voxel_m;
  return CenterOf(place, voxel_m).z() - 0.5 * voxel_m - now.world.level_m;
}

std::vector<ExplorationCandidate> ExplorationCandidates::At(const VoxelKey& place) {
  std::vector<ExplorationCandidate> found;
  std::optional<ExplorationCandidate> here;
  VoxelKey beyond;
  if (policy::IsGroundFrontier(now_.world.ground, place, &beyond)) {
    if (!clustered_.contains(place)) here = FrontierAt(place, beyond);
  } else if (!now_.world.coverage.IsInspected(place)) {
    here = UninspectedAt(place);
  }
  if (here) found.push_back(std::move(*here));
  for (Hints::View& hint : hints_.SeenFrom(place)) {
    const auto type = hint.is_nearer ? ExplorationClass::kHint : ExplorationClass::kHintFromAfar;
    const bool is_on_floor = std::abs(RiseOf(now_, place)) < now_.config.policy.explore.storey_m;
    found.push_back({type, std::move(hint.candidate), place, is_on_floor, false, std::nullopt});
  }
  return found;
}

std::vector<ExplorationCandidate> ExplorationCandidates::OffLevelAt(const VoxelKey& place) {
  VoxelKey beyond;
  const bool is_storey_away = std::abs(RiseOf(now_, place)) >= now_.config.policy.explore.storey_m;
  const bool is_wanted =
      is_storey_away ||
      (policy::IsGroundFrontier(now_.world.ground, place, &beyond) && LeadsToStorey(now_, place));
  return is_wanted ? At(place) : std::vector<ExplorationCandidate>();
}

std::vector<FlightAhead> ExplorationCandidates::FlightsAhead(
    const std::function<bool(const FlightAhead&)>& may_win) const {
  const planner::GroundMap& ground = now_.world.ground;
  planner::GroundPlaces& places = ground.places();
  std::vector<FlightAhead> ahead;
  // Steps of a place whose ground changed may lead to places that the cache has not: it grows.
  for (std::int32_t place = 0; place < static_cast<std::int32_t>(places.size()); ++place) {
    const bool is_known = places.AreStepsKnown(ground, place);
    if (!is_known && !ground.IsStanding(places.KeyAt(place))) continue;
    VoxelKey beyond;
    if (!policy::IsGroundFrontier(ground, place, &beyond)) continue;
    const VoxelKey key = places.KeyAt(place);
    const FlightAhead flight{place, key, CenterOf(beyond, now_.config.map.voxel_m),
                             RiseOf(now_, key)};
    if (may_win(flight) && ground.IsStanding(key) && LeadsToStorey(now_, key) &&
        !WasTried(now_, CandidateKind::kTraversableFrontier, flight.p_focus_world))
      ahead.push_back(flight);
  }
  return ahead;
}

/// A frontier is about its nearest member that was not tried in vain.
std::optional<ExplorationCandidate> ExplorationCandidates::FrontierAt(const VoxelKey& place,
                                                                      const VoxelKey& beyond) {
  const double voxel_m = now_.config.map.voxel_m;
  const Vector3d p_focus_world = CenterOf(beyond, voxel_m);
  if (WasTried(now_, CandidateKind::kTraversableFrontier, p_focus_world)) return std::nullopt;
  ExplorationCandidate found;
  found.place = place;
  found.candidate = policy::GroundFrontierAround(now_.world.ground, place, &clustered_);
  found.candidate.p_focus_world = p_focus_world;
  found.is_on_level = IsOnLevel(now_, CenterOf(place, voxel_m));
  found.candidate.kind =
      found.is_on_level ? CandidateKind::kTraversableFrontier : CandidateKind::kStairFrontier;
  if (LeadsToStorey(now_, place)) {
    found.type = ExplorationClass::kFlight;
    found.is_beside_step = IsBesideStep(now_.world.ground, place);
    return found;
  }
  // The first tread of a flight may border on unseen ground of the level: it counts for itself.
  for (const VoxelKey& member : found.candidate.standing)
    if (LeadsToStorey(now_, member)) clustered_.erase(member);
  found.to_hint_m = hints_.StraightTo(place);
  return found;
}

std::optional<ExplorationCandidate> ExplorationCandidates::UninspectedAt(const VoxelKey& place) {
  if (!uninspected_.insert({place.x >> 2, place.y >> 2, place.z >> 2}).second) return std::nullopt;
  const Vector3d p_world = CenterOf(place, now_.config.map.voxel_m);
  ExplorationCandidate found;
  found.type = ExplorationClass::kUninspected;
  found.place = place;
  found.is_on_level = IsOnLevel(now_, p_world);
  // No object stands on a stair or a slope.
  if (!found.is_on_level && !policy::IsFlatAround(now_.world.map, p_world)) return std::nullopt;
  int count = 0;
  for (int dx = -2; dx <= 2; ++dx)
    for (int dy = -2; dy <= 2; ++dy) {
      const auto z = now_.world.ground.StandingNear(place.x + dx, place.y + dy, place.z, 1);
      count += z && !now_.world.coverage.IsInspected({place.x + dx, place.y + dy, *z});
    }
  if (count < now_.config.policy.explore.min_uninspected) return std::nullopt;
  found.candidate.kind = CandidateKind::kUninspected;
  found.candidate.p_focus_world = p_world;
  found.candidate.standing = {place};
  found.candidate.size = count;
  if (WasTried(now_, found.candidate.kind, p_world)) return std::nullopt;
  return found;
}

}  // namespace crossnav::agent
