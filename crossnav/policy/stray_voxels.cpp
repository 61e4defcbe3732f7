// SPDX-License-Identifier: MIT
#include "crossnav/policy/stray_voxels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/policy/live_poi.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;

constexpr double kLeastRange_m = 0.5;  // chosen: nearer frames say no more
constexpr double kBehind_vox = 1.5;    // chosen: centres of the floor's voxels are below it
constexpr float kLooks = 2;            // chosen: so many frames from one range say as much as all

/// Pixels of the object grow with the square of nearness.
float WeightOf(double range_m) {
  const double r = std::max(range_m, kLeastRange_m);
  return static_cast<float>(1 / (r * r));
}

/// The depth image shows what is in the voxel at `p_camera`: a surface, or one behind it.
bool IsShown(const Vector3d& p_camera, const Observation& obs, double voxel_m) {
  if (p_camera.z() <= 0) return false;
  const double u = std::round(obs.camera.fx * p_camera.x() / p_camera.z() + obs.camera.cx);
  const double v = std::round(obs.camera.fy * p_camera.y() / p_camera.z() + obs.camera.cy);
  if (!(u >= 0 && v >= 0 && u < obs.depth_m.width && v < obs.depth_m.height)) return false;
  const double depth_m = obs.depth_m.At(static_cast<int>(u), static_cast<int>(v));
  return std::isfinite(depth_m) && depth_m > 0 && depth_m >= p_camera.z() - kBehind_vox * voxel_m;
}

bool Has(const std::vector<VoxelKey>& sorted, const VoxelKey& key) {
  return std::binary_search(sorted.begin(), sorted.end(), key);
}

/// The sighting, its parts behind something nearer included, has the voxel or one that touches it.
bool Touches(const Sighting& sighting, const VoxelKey& key) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const VoxelKey beside = key + VoxelKey{x, y, z};
        if (Has(sighting.voxels, beside) || Has(sighting.other_parts, beside)) return true;
      }
  return false;
}

/// The frame shows what is in the voxel, and the object is elsewhere.
bool IsBeside(const VoxelKey& key, const Sighting& sighting, const Vector3d& p_camera,
              const Observation& obs, double voxel_m) {
  return IsShown(p_camera, obs, voxel_m) && !Touches(sighting, key);
}

}  // namespace

std::vector<VoxelKey> WithoutStrays(const std::vector<VoxelKey>& voxels, const Sighting& sighting,
                                    const Observation& obs, double voxel_m) {
  const Pose T_camera_world = obs.T_world_camera.inverse();
  std::vector<VoxelKey> kept;
  for (const VoxelKey& key : voxels)
    if (!IsBeside(key, sighting, T_camera_world * geometry::CenterOf(key, voxel_m), obs, voxel_m))
      kept.push_back(key);
  return kept;
}

void VoteOnVoxels(const Sighting& sighting, const Observation& obs, double voxel_m,
                  std::vector<VoxelKey>* voxels, VoxelVotes* votes) {
  const Pose T_camera_world = obs.T_world_camera.inverse();
  std::vector<VoxelKey> kept;
  VoxelVotes kept_votes;
  for (std::size_t i = 0; i < voxels->size(); ++i) {
    const VoxelKey key = (*voxels)[i];
    const Vector3d p_camera = T_camera_world * geometry::CenterOf(key, voxel_m);
    const float weight = WeightOf(p_camera.norm());
    float vote = (*votes)[i];
    if (Has(sighting.voxels, key))
      vote = std::max(vote, std::min(vote + weight, kLooks * weight));
    else if (IsBeside(key, sighting, p_camera, obs, voxel_m))
      vote -= weight;
    if (vote < 0) continue;
    kept.push_back(key);
    kept_votes.push_back(vote);
  }
  if (kept.empty()) return;
  *voxels = std::move(kept);
  *votes = std::move(kept_votes);
}

}  // namespace crossnav::policy
