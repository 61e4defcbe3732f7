// SPDX-License-Identifier: MIT
#include "crossnav/policy/flights.h"

#include <algorithm>

namespace crossnav::policy {
namespace {

constexpr double kSameEnd_m = 1.0;  // chosen: landings are at least that deep
constexpr int kBeside_vox = 2;      // chosen: a tread may be seen beside the foot only

bool IsSame(const geometry::StairFlight& a, const geometry::StairFlight& b) {
  return (a.p_foot_world - b.p_foot_world).norm() <= kSameEnd_m &&
         (a.p_top_world - b.p_top_world).norm() <= kSameEnd_m;
}

bool HasEvidence(const Vector3d& p_world, const StairEvidence& evidence, double voxel_m) {
  const VoxelKey foot = geometry::KeyOf(p_world, voxel_m);
  for (int dx = -kBeside_vox; dx <= kBeside_vox; ++dx)
    for (int dy = -kBeside_vox; dy <= kBeside_vox; ++dy) {
      const auto it =
          evidence.voxels().lower_bound({foot.x + dx, foot.y + dy, foot.z - kBeside_vox});
      if (it != evidence.voxels().end() && it->first.x == foot.x + dx &&
          it->first.y == foot.y + dy && it->first.z <= foot.z + kBeside_vox)
        return true;
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

const geometry::StairFlight& NoteWalk(const std::vector<Vector3d>& way_world,
                                      const StairEvidence& evidence, double voxel_m,
                                      std::vector<geometry::StairFlight>* flights) {
  const bool is_up = way_world.back().z() > way_world.front().z();
  geometry::StairFlight walked;
  walked.steps_world = way_world;
  if (!is_up) std::reverse(walked.steps_world.begin(), walked.steps_world.end());
  walked.p_foot_world = walked.steps_world.front();
  walked.p_top_world = walked.steps_world.back();
  walked.confidence = EvidenceShare(walked.steps_world, evidence, voxel_m);
  auto known = std::find_if(flights->begin(), flights->end(),
                            [&](const geometry::StairFlight& f) { return IsSame(f, walked); });
  if (known == flights->end()) {
    flights->push_back(std::move(walked));
    known = flights->end() - 1;
  } else {
    known->confidence = std::max(known->confidence, walked.confidence);
  }
  ++(is_up ? known->walked_up : known->walked_down);
  return *known;
}

}  // namespace crossnav::policy
