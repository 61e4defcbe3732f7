// SPDX-License-Identifier: MIT
#include "crossnav/policy/flight_survey.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <unordered_map>
#include <utility>

#include "crossnav/policy/clusters.h"
#include "crossnav/policy/flights.h"

namespace crossnav::policy {
namespace {

using geometry::StairFlight;

constexpr int kCell_vox = 3;               // chosen: a tread; nearer evidence is the same flight
constexpr double kMinFlightRise_m = 0.45;  // chosen: two to three risers
constexpr int kMinConfirmed_vox = 5;       // chosen: as the smallest frontier
constexpr double kEnd_m = 0.35;  // chosen: the level band, in which a flight begins and ends

VoxelKey CellOf(const VoxelKey& key) {
  const auto down = [](int i) { return (i >= 0 ? i : i - kCell_vox + 1) / kCell_vox; };
  return {down(key.x), down(key.y), down(key.z)};
}

/// Part of a cluster in one layer of voxels.
struct Layer {
  Vector3d sum_world = Vector3d::Zero();
  double probability = 0;
  int count = 0;
  int confirmed = 0;
};
using Layers = std::map<int, Layer>;  // by z of the key

/// Evidence in clusters of cells, without the heights of walked flights that run through a cluster.
std::vector<Layers> Clusters(const StairEvidence& evidence, double voxel_m,
                             const std::vector<StairFlight>& flights) {
  std::vector<VoxelKey> cells;
  for (const auto& [key, voxel] : evidence.voxels()) cells.push_back(CellOf(key));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  std::unordered_map<VoxelKey, std::size_t, geometry::VoxelKeyHash> cluster_of;
  std::vector<std::vector<const StairFlight*>> walked;  // of a cluster
  for (const auto& cluster : ConnectedClusters(std::move(cells))) {
    for (const VoxelKey& cell : cluster) cluster_of[cell] = walked.size();
    walked.emplace_back();
    for (const StairFlight& flight : flights) {
      const bool is_in = std::any_of(cluster.begin(), cluster.end(), [&](const VoxelKey& cell) {
        return IsBeside(flight, CenterOf(cell, kCell_vox * voxel_m));
      });
      if (flight.IsWalked() && is_in) walked.back().push_back(&flight);
    }
  }
  std::vector<Layers> clusters(walked.size());
  for (const auto& [key, voxel] : evidence.voxels()) {
    const std::size_t cluster = cluster_of.at(CellOf(key));
    const Vector3d p_world = CenterOf(key, voxel_m);
    const bool is_walked =
        std::any_of(walked[cluster].begin(), walked[cluster].end(), [&](const StairFlight* flight) {
          return p_world.z() > flight->p_foot_world.z() - kEnd_m - voxel_m &&
                 p_world.z() < flight->p_top_world.z();
        });
    if (is_walked) continue;
    Layer& layer = clusters[cluster][key.z];
    layer.sum_world += p_world;
    layer.probability += voxel.probability;
    ++layer.count;
    layer.confirmed += voxel.is_confirmed;
  }
  std::erase_if(clusters, [](const Layers& layers) { return layers.empty(); });
  return clusters;
}

/// The record of a run of layers; no steps where it is none.
StairFlight FlightOf(Layers::const_iterator from, Layers::const_iterator to, double voxel_m) {
  StairFlight flight;
  double probability = 0;
  int count = 0, confirmed = 0;
  for (auto it = from; it != to; ++it) {
    const Layer& layer = it->second;
    flight.steps_world.push_back(layer.sum_world / layer.count);
    flight.steps_world.back().z() += 0.5 * voxel_m;  // the tread is the upper face
    probability += layer.probability;
    count += layer.count;
    confirmed += layer.confirmed;
  }
  if (confirmed < kMinConfirmed_vox ||
      flight.steps_world.back().z() - flight.steps_world.front().z() < kMinFlightRise_m) {
    flight.steps_world.clear();
    return flight;
  }
  flight.p_foot_world = flight.steps_world.front();
  flight.p_top_world = flight.steps_world.back();
  flight.confidence = probability / count;
  return flight;
}

/// Flights of the evidence, lowest first within a cluster.
std::vector<StairFlight> Survey(const StairEvidence& evidence, std::span<const double> levels_m,
                                double voxel_m, const std::vector<StairFlight>& flights) {
  std::vector<StairFlight> surveyed;
  for (const Layers& layers : Clusters(evidence, voxel_m, flights)) {
    std::vector<double> cuts_m;
    const double low_m = layers.begin()->first * voxel_m;
    const double high_m = (layers.rbegin()->first + 1) * voxel_m;
    for (const double level_m : levels_m)
      if (level_m > low_m + kEnd_m && level_m < high_m - kEnd_m) cuts_m.push_back(level_m);
    std::sort(cuts_m.begin(), cuts_m.end());
    auto from = layers.begin();
    for (std::size_t i = 0; i <= cuts_m.size(); ++i) {
      const auto to =
          i == cuts_m.size()
              ? layers.end()
              : layers.upper_bound(static_cast<int>(std::lround(cuts_m[i] / voxel_m)) - 1);
      if (from != to)
        if (auto flight = FlightOf(from, to, voxel_m); !flight.steps_world.empty())
          surveyed.push_back(std::move(flight));
      from = to;
    }
  }
  return surveyed;
}

}  // namespace

void FlightSurvey::Update(const StairEvidence& evidence, std::span<const double> levels_m,
                          const Vector3d& p_agent_world, double voxel_m,
                          std::vector<StairFlight>* flights) {
  int walks = 0;
  for (const StairFlight& flight : *flights) walks += flight.walked_up + flight.walked_down;
  if (evidence.revision() != revision_ || walks != walks_ || levels_m.size() != levels_) {
    revision_ = evidence.revision();
    walks_ = walks;
    levels_ = levels_m.size();
    auto surveyed = Survey(evidence, levels_m, voxel_m, *flights);
    int next_id = NextId(*flights);
    std::vector<StairFlight> before;
    for (auto it = flights->begin(); it != flights->end();) {
      if (it->IsWalked()) {
        ++it;
        continue;
      }
      before.push_back(std::move(*it));
      it = flights->erase(it);
    }
    for (StairFlight& flight : surveyed) {
      flight.id = next_id;
      for (auto it = before.begin(); it != before.end();) {
        if (!AreSameStairs(flight, *it)) {
          ++it;
          continue;
        }
        TakeHistory(std::move(*it), &flight);
        it = before.erase(it);
      }
      next_id += flight.id == next_id;
    }
    std::sort(surveyed.begin(), surveyed.end(),
              [](const StairFlight& a, const StairFlight& b) { return a.id < b.id; });
    std::move(surveyed.begin(), surveyed.end(), std::back_inserter(*flights));
  }
  for (StairFlight& flight : *flights) {
    const bool is_new =
        !IsSeenFrom(flight, p_agent_world) &&
        std::any_of(evidence.last_seen().begin(), evidence.last_seen().end(),
                    [&](const VoxelKey& key) { return IsBeside(flight, CenterOf(key, voxel_m)); });
    if (is_new) flight.seen_from_world.push_back(p_agent_world);
  }
}

}  // namespace crossnav::policy
