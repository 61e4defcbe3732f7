// SPDX-License-Identifier: MIT
#include "crossnav/policy/flights.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crossnav::policy {
namespace {

constexpr double kSameEnd_m = 1.0;    // chosen: landings are at least that deep
constexpr double kSamePlace_m = 1.0;  // chosen: four forward steps
constexpr int kBeside_vox = 2;        // chosen: a tread may be seen beside the foot only

bool IsSame(const geometry::StairFlight& a, const geometry::StairFlight& b) {
  return a.IsWalked() && b.IsWalked() && (a.p_foot_world - b.p_foot_world).norm() <= kSameEnd_m &&
         (a.p_top_world - b.p_top_world).norm() <= kSameEnd_m;
}

bool HasEvidence(const Vector3d& p_world, const StairEvidence& evidence, double voxel_m) {
  const auto& voxels = evidence.voxels();
  const VoxelKey foot = geometry::KeyOf(p_world, voxel_m);
  const VoxelKey lo = foot - VoxelKey{kBeside_vox, kBeside_vox, kBeside_vox};
  const VoxelKey hi = foot + VoxelKey{kBeside_vox, kBeside_vox, kBeside_vox};
  for (int x = lo.x; x <= hi.x; ++x) {
    // From column to column that has evidence.
    auto it = voxels.lower_bound({x, lo.y, lo.z});
    while (it != voxels.end() && it->first.x == x && it->first.y <= hi.y) {
      const VoxelKey& key = it->first;
      if (key.z >= lo.z && key.z <= hi.z) return true;
      it = voxels.lower_bound({x, key.z < lo.z ? key.y : key.y + 1, lo.z});
    }
  }
  return false;
}

}  // namespace

double EvidenceShare(const std::vector<Vector3d>& points_world, const StairEvidence& evidence,
                     double voxel_m) {
  const auto seen = std::count_if(points_world.begin(), points_world.end(), [&](const Vector3d& p) {
    return HasEvidence(p, evidence, voxel_m);
  });
  return points_world.empty()
             ? 0
             : static_cast<double>(seen) / static_cast<double>(points_world.size());
}

bool IsBeside(const geometry::StairFlight& flight, const Vector3d& p_world) {
  return std::any_of(
      flight.steps_world.begin(), flight.steps_world.end(),
      [&](const Vector3d& p_step) { return (p_step - p_world).norm() <= kSameEnd_m; });
}

std::vector<VoxelKey> EvidenceOn(const geometry::StairFlight& flight, const StairEvidence& evidence,
                                 double voxel_m) {
  std::vector<VoxelKey> keys;
  for (const auto& [key, voxel] : evidence.voxels())
    if (IsBeside(flight, CenterOf(key, voxel_m))) keys.push_back(key);
  return keys;
}

bool AreSameStairs(const geometry::StairFlight& a, const geometry::StairFlight& b) {
  const auto is_part = [](const geometry::StairFlight& part, const geometry::StairFlight& whole) {
    const auto beside =
        std::count_if(part.steps_world.begin(), part.steps_world.end(),
                      [&](const Vector3d& p_step) { return IsBeside(whole, p_step); });
    return 2 * beside > static_cast<std::ptrdiff_t>(part.steps_world.size());
  };
  return is_part(a, b) || is_part(b, a);
}

void TakeHistory(geometry::StairFlight from, geometry::StairFlight* flight) {
  flight->id = std::min(flight->id, from.id);
  for (const Vector3d& p_world : from.seen_from_world) AddSeenFrom(p_world, flight);
  flight->tries.insert(flight->tries.begin(), std::make_move_iterator(from.tries.begin()),
                       std::make_move_iterator(from.tries.end()));
}

void NoteTry(const Vector3d& p_target_world, const geometry::FlightTry& attempt,
             std::vector<geometry::StairFlight>* flights) {
  for (geometry::StairFlight& flight : *flights) {
    if (!IsBeside(flight, p_target_world)) continue;
    flight.tries.push_back(attempt);
    return;
  }
}

bool IsSeenFrom(const geometry::StairFlight& flight, const Vector3d& p_world) {
  return std::any_of(flight.seen_from_world.begin(), flight.seen_from_world.end(),
                     [&](const Vector3d& p) { return (p - p_world).norm() < kSamePlace_m; });
}

void AddSeenFrom(const Vector3d& p_world, geometry::StairFlight* flight) {
  if (!IsSeenFrom(*flight, p_world)) flight->seen_from_world.push_back(p_world);
}

int NextId(const std::vector<geometry::StairFlight>& flights) {
  int next = 0;
  for (const geometry::StairFlight& flight : flights) next = std::max(next, flight.id + 1);
  return next;
}

const geometry::StairFlight& NoteWalk(const std::vector<Vector3d>& path_world,
                                      const StairEvidence& evidence, double voxel_m,
                                      std::vector<geometry::StairFlight>* flights) {
  const bool is_up = path_world.back().z() > path_world.front().z();
  geometry::StairFlight walked;
  walked.steps_world = path_world;
  if (!is_up) std::reverse(walked.steps_world.begin(), walked.steps_world.end());
  walked.p_foot_world = walked.steps_world.front();
  walked.p_top_world = walked.steps_world.back();
  walked.confidence = EvidenceShare(walked.steps_world, evidence, voxel_m);
  walked.id = NextId(*flights);
  ++(is_up ? walked.walked_up : walked.walked_down);

  // Seen flights along the path, and the record of an earlier walk.
  for (auto it = flights->begin(); it != flights->end();) {
    const bool is_part = !it->IsWalked() && AreSameStairs(walked, *it);
    if (!is_part && !IsSame(*it, walked)) {
      ++it;
      continue;
    }
    if (!is_part) {
      walked.p_foot_world = it->p_foot_world;
      walked.p_top_world = it->p_top_world;
      walked.steps_world = std::move(it->steps_world);
      walked.confidence = std::max(walked.confidence, it->confidence);
      walked.walked_up += it->walked_up;
      walked.walked_down += it->walked_down;
    }
    TakeHistory(std::move(*it), &walked);
    it = flights->erase(it);
  }
  // Walked flights first, in order of discovery.
  const auto place = std::find_if(flights->begin(), flights->end(), [&](const auto& flight) {
    return !flight.IsWalked() || flight.id > walked.id;
  });
  return *flights->insert(place, std::move(walked));
}

}  // namespace crossnav::policy
