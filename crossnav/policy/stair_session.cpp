// SPDX-License-Identifier: MIT
#include "crossnav/policy/stair_session.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "crossnav/core/cells.h"
#include "crossnav/policy/stair_geometry.h"

namespace crossnav::policy {
namespace {

using geometry::CenterOf;
using geometry::StairMark;
using geometry::Voxel;
using geometry::VoxelState;

constexpr double kMinRise_m = 0.40;  // chosen: two low risers; less is not another level
constexpr double kLandingReach_m =
    1.3;  // chosen: far enough from the last step to stand on flat ground
constexpr double kLandingStart_m = 0.45;  // chosen: the disc of IsFlatAround
constexpr double kSmallLanding_m2 = 6.0;  // chosen: half landings are smaller, rooms larger

/// Coarse occupancy of the cluster: answers "is any cluster voxel within one admission radius".
class NearCluster {
 public:
  NearCluster(const std::set<VoxelKey>& cluster, int radius_vox)
      : radius_(std::max(1, radius_vox)) {
    for (const VoxelKey& key : cluster) cells_[CellOf(key)].push_back(key);
  }
  bool Contains(const VoxelKey& key) const {
    const VoxelKey cell = CellOf(key);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto it = cells_.find(cell + VoxelKey{dx, dy, dz});
          if (it == cells_.end()) continue;
          for (const VoxelKey& other : it->second)
            if (VoxelDistance(key, other) <= radius_) return true;
        }
    return false;
  }

 private:
  VoxelKey CellOf(const VoxelKey& key) const {
    const auto floor_div = [this](int a) {
      return a >= 0 ? a / radius_ : -((-a + radius_ - 1) / radius_);
    };
    return {floor_div(key.x), floor_div(key.y), floor_div(key.z)};
  }
  int radius_;
  std::map<VoxelKey, std::vector<VoxelKey>> cells_;
};

/// OCCUPIED neighbours of `added` that carry a foot: free air above, a step away in height.
std::vector<VoxelKey> ExpandableNeighbours(const std::vector<VoxelKey>& added,
                                           const VoxelMap& map) {
  std::vector<VoxelKey> neighbours;
  VoxelMap::Cursor cursor(map);
  for (const VoxelKey& key : added)
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const VoxelKey next{key.x + dx, key.y + dy, key.z + dz};
          if (cursor.At(next).state != VoxelState::kOccupied) continue;
          const VoxelState above = cursor.At({next.x, next.y, next.z + 1}).state;
          if (above == VoxelState::kTraversable || above == VoxelState::kTraversableStair)
            neighbours.push_back(next);
        }
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  return neighbours;
}

double RiseOf(const StairSession& session, double z_m) {
  return session.direction * (z_m - session.entrance_level_m);
}

}  // namespace

StairSession BeginSession(int direction, double entrance_level_m, const Vector3d& p_world_foot,
                          const std::vector<VoxelKey>& flight) {
  StairSession session;
  session.direction = direction;
  session.entrance_level_m = entrance_level_m;
  session.p_entrance_world = p_world_foot;
  const auto treads = ColumnTops(flight);
  session.cluster.insert(treads.begin(), treads.end());
  return session;
}

void PromoteStairs(StairSession& session, const StairEvidence& evidence, VoxelMap& map,
                   const StairConfig& config) {
  const double voxel_m = map.config().voxel_m;
  const NearCluster near(session.cluster, CellsFloor(config.admission_radius_m, voxel_m));
  std::vector<VoxelKey> added, rejected;
  for (const auto& [key, voxel] : evidence.voxels()) {
    const bool is_accepted =
        session.direction > 0
            ? voxel.geometry_score >= config.geometry_threshold
            : (voxel.geometry_score + voxel.probability) / 2 >= config.descent_confirmation;
    if (RiseOf(session, CenterOf(key, voxel_m).z()) < -0.3)
      continue;  // another flight, in the other direction
    if (map.StairMarkAt(key) == StairMark::kStair || !near.Contains(key)) continue;
    if (!is_accepted) {
      if (map.StairMarkAt(key) == StairMark::kNone) rejected.push_back(key);
      continue;
    }
    // Only the top voxel of a column carries a foot; risers and sides do not.
    if (IsSurface(map.StateAt({key.x, key.y, key.z + 1}))) continue;
    added.push_back(key);
  }
  map.MarkStair(added, StairMark::kStair);
  map.MarkStair(rejected, StairMark::kFake);
  session.cluster.insert(added.begin(), added.end());
  const auto expanded = ExpandableNeighbours(added, map);
  std::vector<VoxelKey> fresh;
  for (const VoxelKey& key : expanded) {
    if (map.StairMarkAt(key) == StairMark::kNone) fresh.push_back(key);
  }
  map.MarkStair(fresh, StairMark::kExpanded);
}

SessionStatus AdvanceSession(StairSession& session, const VoxelMap& map,
                             const Vector3d& p_world_foot, const StairConfig& config) {
  ++session.steps;
  const double progress_m = RiseOf(session, p_world_foot.z());
  if (progress_m > session.best_progress_m + 0.05) {
    session.best_progress_m = progress_m;
    session.steps_without_progress = 0;
  } else {
    ++session.steps_without_progress;
  }
  const bool is_away = progress_m >= kMinRise_m;
  session.landing_frames =
      is_away && IsFlatAround(map, p_world_foot) ? session.landing_frames + 1 : 0;
  if (session.landing_frames >= config.landing_frames) return SessionStatus::kOnLanding;
  if (session.steps_without_progress > config.min_progress_steps) return SessionStatus::kStalled;
  return SessionStatus::kClimbing;
}

namespace {

/// Height span of a session's cluster, and its voxels next to the far end.
struct ClusterSpan {
  VoxelKey lo, hi;
  double extreme_m = -1e9;  ///< rise of the farthest voxel
  std::vector<VoxelKey> extreme;
};

ClusterSpan SpanOf(const StairSession& session, double voxel_m) {
  ClusterSpan span;
  const auto rise_m = [&](const VoxelKey& key) {
    return RiseOf(session, CenterOf(key, voxel_m).z());
  };
  span.lo = span.hi = *session.cluster.begin();
  for (const VoxelKey& key : session.cluster) {
    span.lo = {std::min(span.lo.x, key.x), std::min(span.lo.y, key.y), std::min(span.lo.z, key.z)};
    span.hi = {std::max(span.hi.x, key.x), std::max(span.hi.y, key.y), std::max(span.hi.z, key.z)};
    span.extreme_m = std::max(span.extreme_m, rise_m(key));
  }
  for (const VoxelKey& key : session.cluster) {
    if (rise_m(key) > span.extreme_m - 0.25) span.extreme.push_back(key);
  }
  return span;
}

/// Beyond the last step, far enough from every step to stand on flat ground.
bool IsLanding(const StairSession& session, const ClusterSpan& span, const VoxelKey& key,
               double voxel_m) {
  const auto is_within = [&](double reach_m) {
    return [&, reach_m](const VoxelKey& stair) {
      return VoxelDistance(key, stair) * voxel_m <= reach_m;
    };
  };
  if (std::none_of(span.extreme.begin(), span.extreme.end(), is_within(kLandingReach_m)))
    return false;
  return std::all_of(session.cluster.begin(), session.cluster.end(), [&](const VoxelKey& stair) {
    return VoxelDistance(key, stair) * voxel_m >= kLandingStart_m;
  });
}

/// A place to stand on the flight or on the landing beyond it.
struct StairPlace {
  VoxelKey key;
  double rise_m;
  bool is_landing;
};

std::vector<StairPlace> PlacesOn(const StairSession& session, const ClusterSpan& span,
                                 const VoxelMap& map) {
  const double voxel_m = map.config().voxel_m;
  const int reach = CellsCeil(kLandingReach_m, voxel_m);
  std::vector<StairPlace> places;
  VoxelMap::Cursor cursor(map);
  map.ForEachInBox(
      span.lo - VoxelKey{reach, reach, 2}, span.hi + VoxelKey{reach, reach, 4},
      [&](const VoxelKey& key, const Voxel& voxel) {
        if (!IsPathable(voxel.state) || IsSurface(voxel.state) || voxel.is_inflated) return;
        if (!IsSurface(cursor.At({key.x, key.y, key.z - 1}).state)) return;
        const double rise_m = RiseOf(session, geometry::MinCornerOf(key, voxel_m).z());
        if (voxel.state == VoxelState::kTraversableStair)
          places.push_back({key, rise_m, false});
        else if (std::abs(rise_m - span.extreme_m) <= 0.3 && IsLanding(session, span, key, voxel_m))
          places.push_back({key, rise_m, true});
      });
  return places;
}

}  // namespace

std::vector<Candidate> StairFrontiers(const StairSession& session, const VoxelMap& map,
                                      const Vector3d& p_world_foot) {
  if (session.cluster.empty()) return {};
  const double voxel_m = map.config().voxel_m;
  // Bands of two voxels of progress; a landing counts as half a metre beyond its steps.
  std::map<int, std::vector<VoxelKey>> bands;
  for (const StairPlace& place : PlacesOn(session, SpanOf(session, voxel_m), map)) {
    if (place.rise_m < 0.05) continue;
    const double progress = place.rise_m + (place.is_landing ? 0.5 : 0.0);
    bands[-CellsFloor(progress, 2 * voxel_m)].push_back(place.key);
  }
  std::vector<Candidate> candidates;
  for (auto& [band, keys] : bands) {
    Candidate candidate;
    candidate.kind = CandidateKind::kStairFrontier;
    std::sort(keys.begin(), keys.end());
    candidate.size = static_cast<int>(keys.size());
    candidate.score = -band * 2 * voxel_m;
    Vector3d sum = Vector3d::Zero();
    for (const VoxelKey& key : keys) sum += CenterOf(key, voxel_m);
    candidate.p_focus_world = sum / static_cast<double>(keys.size());
    // Where the agent already stands is no target.
    std::erase_if(keys, [&](const VoxelKey& key) {
      return (CenterOf(key, voxel_m) - p_world_foot).head<2>().norm() < 0.2;
    });
    candidate.standing = std::move(keys);
    if (!candidate.standing.empty()) candidates.push_back(std::move(candidate));
    if (candidates.size() >= 8) break;  // chosen: eight bands are 1.6 m of height
  }
  return candidates;
}

bool FlightContinues(const StairSession& session, const StairEvidence& evidence,
                     const VoxelMap& map, const Vector3d& p_world_foot, const StairConfig& config) {
  const double voxel_m = map.config().voxel_m;
  const auto flights = FlightsFrom(evidence, map, p_world_foot.z(), session.direction);
  const bool has_flight = std::any_of(flights.begin(), flights.end(), [&](const Flight& flight) {
    return (flight.p_entrance_world - p_world_foot).head<2>().norm() <= config.admission_radius_m &&
           flight.geometry_score >= config.geometry_threshold;
  });
  if (!has_flight) return false;
  const auto around = SupportsAround(map, p_world_foot, 2.5);
  int flat = 0;
  for (const VoxelKey& key : around) {
    const bool is_stair = map.StairMarkAt(key) != StairMark::kNone;
    flat += !is_stair &&
            std::abs(geometry::MinCornerOf(key, voxel_m).z() + voxel_m - p_world_foot.z()) <= 0.15;
  }
  return flat * voxel_m * voxel_m < kSmallLanding_m2;
}

}  // namespace crossnav::policy
