// SPDX-License-Identifier: MIT
#include "crossnav/policy/stair_evidence.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "crossnav/core/cells.h"
#include "crossnav/policy/clusters.h"
#include "crossnav/policy/stair_geometry.h"

namespace crossnav::policy {
namespace {

using geometry::CenterOf;
using geometry::EndRun;

/// Labels of the 4-connected components of the mask with at least `min_px` pixels; 0 = none.
Image<std::int32_t> LabelComponents(const Image<float>& probability, double threshold, int min_px,
                                    int* count) {
  Image<std::int32_t> labels(probability.width, probability.height, 0);
  std::vector<std::int32_t> stack, members;
  int next = 0;
  const auto size = static_cast<std::int32_t>(probability.data.size());
  for (std::int32_t seed = 0; seed < size; ++seed) {
    if (labels.data[seed] != 0 || probability.data[seed] < threshold) continue;
    members.clear();
    labels.data[seed] = next + 1;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::int32_t p = stack.back();
      stack.pop_back();
      members.push_back(p);
      const int u = p % labels.width, v = p / labels.width;
      const auto visit = [&](bool is_inside, std::int32_t q) {
        if (!is_inside || labels.data[q] != 0 || probability.data[q] < threshold) return;
        labels.data[q] = next + 1;
        stack.push_back(q);
      };
      visit(u > 0, p - 1);
      visit(u + 1 < labels.width, p + 1);
      visit(v > 0, p - labels.width);
      visit(v + 1 < labels.height, p + labels.width);
    }
    if (static_cast<int>(members.size()) >= min_px)
      ++next;
    else
      for (const std::int32_t p : members) labels.data[p] = -1;
  }
  *count = next;
  return labels;
}

struct Lifted {
  std::map<VoxelKey, double> probability;  // best over the pixels
};

}  // namespace

void StairEvidence::Update(const Image<float>& probability, const std::vector<EndRun>& ends,
                           const VoxelMap& map, const StairConfig& config, int step) {
  last_seen_.clear();
  const bool has_any = std::any_of(probability.data.begin(), probability.data.end(),
                                   [&](float p) { return p >= config.pixel_threshold; });
  if (!has_any) return;
  int count = 0;
  const auto labels =
      LabelComponents(probability, config.pixel_threshold, config.min_component_px, &count);
  std::vector<Lifted> components(static_cast<std::size_t>(count));
  std::int32_t last_label = 0;
  VoxelKey last_key;
  double* best = nullptr;  // of the last pixel's voxel, which is mostly this one's
  for (const EndRun& run : ends) {
    for (std::int32_t pixel = run.pixel; pixel < run.pixel + run.count; ++pixel) {
      const std::int32_t label = labels.data[pixel];
      if (label <= 0) continue;
      if (label != last_label || run.key != last_key)
        best = &components[label - 1].probability[run.key];
      last_label = label;
      last_key = run.key;
      *best = std::max(*best, static_cast<double>(probability.data[pixel]));
    }
  }
  for (const Lifted& component : components) {
    std::vector<VoxelKey> keys;
    for (const auto& [key, p] : component.probability) keys.push_back(key);
    const double score = ScoreStairGeometry(map, keys).Score();
    for (const auto& [key, p] : component.probability) {
      const auto [it, is_new] = voxels_.try_emplace(key);
      StairVoxel& voxel = it->second;
      const int age = step - voxel.last_step;
      voxel.recent = age < 32 ? voxel.recent << age : 0;
      voxel.last_step = step;
      voxel.probability = std::max(voxel.probability, p);
      voxel.geometry_score = std::max(voxel.geometry_score, score);
      if (score >= config.geometry_threshold) {
        voxel.recent |= 1;
        last_seen_.push_back(key);
      }
      const std::uint32_t window = (1u << std::min(config.evidence_window, 31)) - 1;
      const bool is_confirmed =
          voxel.is_confirmed || std::popcount(voxel.recent & window) >= config.evidence_frames;
      revision_ += is_new || is_confirmed != voxel.is_confirmed;
      voxel.is_confirmed = is_confirmed;
    }
  }
}

std::vector<geometry::SeenStair> StairEvidence::Export() const {
  std::vector<geometry::SeenStair> seen;
  const auto share = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); };
  for (const auto& [key, voxel] : voxels_)
    seen.push_back(
        {key, share(voxel.probability), share(voxel.geometry_score), voxel.is_confirmed});
  return seen;
}

void StairEvidence::Import(const std::vector<geometry::SeenStair>& seen) {
  voxels_.clear();
  ++revision_;
  for (const geometry::SeenStair& stair : seen)
    voxels_[stair.key] = {stair.probability, stair.geometry_score, 0, 0, stair.is_confirmed};
}

std::vector<VoxelKey> StairEvidence::Reject(const Vector3d& p_world, double radius_m,
                                            double voxel_m) {
  std::vector<VoxelKey> rejected;
  for (auto it = voxels_.begin(); it != voxels_.end();) {
    if ((CenterOf(it->first, voxel_m) - p_world).norm() <= radius_m) {
      rejected.push_back(it->first);
      ++revision_;
      it = voxels_.erase(it);
    } else {
      ++it;
    }
  }
  return rejected;
}

std::vector<Flight> FlightsFrom(const StairEvidence& evidence, const VoxelMap& map, double level_m,
                                int direction) {
  const double voxel_m = map.config().voxel_m;
  constexpr double kSlack_m = 0.15, kFirstStep_m = 0.45,
                   kMinRise_m = 0.45;  // chosen: one to two risers
  std::vector<VoxelKey> keys;
  for (const auto& [key, voxel] : evidence.voxels()) {
    const double rise_m = direction * (CenterOf(key, voxel_m).z() - level_m);
    if (rise_m > -kSlack_m) keys.push_back(key);
  }
  std::vector<Flight> flights;
  for (auto& cluster : ConnectedClusters(std::move(keys), 2)) {
    const auto rise = [&](const VoxelKey& key) {
      return direction * (CenterOf(key, voxel_m).z() - level_m);
    };
    const auto [low, high] = std::minmax_element(
        cluster.begin(), cluster.end(),
        [&](const VoxelKey& a, const VoxelKey& b) { return rise(a) < rise(b); });
    const double lowest = rise(*low);
    if (lowest > kFirstStep_m || rise(*high) < kMinRise_m) continue;
    Flight flight;
    flight.direction = direction;
    std::vector<VoxelKey> first_step, ahead;
    const auto treads = ColumnTops(cluster);
    double lowest_tread = 1e9;
    for (const VoxelKey& key : treads) lowest_tread = std::min(lowest_tread, rise(key));
    for (const VoxelKey& key : treads) {
      if (rise(key) <= std::max(lowest_tread, 0.0) + 2.5 * voxel_m) first_step.push_back(key);
    }
    flight.p_entrance_world = CentroidOf(first_step, voxel_m);
    double probability = 0;
    int confirmed = 0;
    for (const VoxelKey& key : treads) {
      const Vector3d d = CenterOf(key, voxel_m) - flight.p_entrance_world;
      if (d.head<2>().norm() < 1.2 && rise(key) > 0.3) ahead.push_back(key);
    }
    for (const VoxelKey& key : cluster) {
      const StairVoxel& voxel = evidence.voxels().at(key);
      probability += voxel.probability;
      confirmed += voxel.is_confirmed;
      flight.geometry_score = std::max(flight.geometry_score, voxel.geometry_score);
    }
    flight.p_ahead_world =
        ahead.empty() ? CentroidOf(cluster, voxel_m) : CentroidOf(ahead, voxel_m);
    flight.probability = probability / static_cast<double>(cluster.size());
    flight.is_confirmed = confirmed >= 5;  // chosen: as the smallest frontier
    flight.voxels = std::move(cluster);
    flights.push_back(std::move(flight));
  }
  return flights;
}

std::vector<Candidate> AscentFrontiers(const std::vector<Flight>& flights_up, const VoxelMap& map,
                                       const planner::LevelBand& level, const StairConfig& config) {
  const double voxel_m = map.config().voxel_m;
  constexpr double kFront_m = 1.0;  // chosen: near enough to look at the first steps
  std::vector<Candidate> candidates;
  VoxelMap::Cursor cursor(map);
  for (const Flight& flight : flights_up) {
    if (!flight.is_confirmed || flight.geometry_score < config.geometry_threshold) continue;
    const Eigen::Vector2d ahead = (flight.p_ahead_world - flight.p_entrance_world).head<2>();
    Candidate candidate;
    candidate.kind = CandidateKind::kAscentFrontier;
    candidate.p_focus_world = flight.p_ahead_world;
    candidate.size = static_cast<int>(flight.voxels.size());
    candidate.score = flight.geometry_score;
    const VoxelKey c = geometry::KeyOf(flight.p_entrance_world, voxel_m);
    const int reach = CellsCeil(kFront_m, voxel_m);
    map.ForEachInBox(
        {c.x - reach, c.y - reach, level.min_z + 1}, {c.x + reach, c.y + reach, level.max_z + 1},
        [&](const VoxelKey& key, const geometry::Voxel& voxel) {
          if (voxel.state != geometry::VoxelState::kTraversable || voxel.is_inflated) return;
          if (!IsSurface(cursor.At({key.x, key.y, key.z - 1}).state) || !level.Contains(key.z - 1))
            return;
          const Eigen::Vector2d d = (CenterOf(key, voxel_m) - flight.p_entrance_world).head<2>();
          if (d.norm() <= kFront_m && d.dot(ahead) <= 0) candidate.standing.push_back(key);
        });
    std::sort(candidate.standing.begin(), candidate.standing.end());
    if (!candidate.standing.empty()) candidates.push_back(std::move(candidate));
  }
  return candidates;
}

}  // namespace crossnav::policy
