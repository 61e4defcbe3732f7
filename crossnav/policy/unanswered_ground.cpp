// SPDX-License-Identifier: MIT
#include "crossnav/policy/unanswered_ground.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/core/camera.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;

constexpr int kImageRays = 80;   // chosen: across the image; a voxel at three metres takes two
constexpr double kNear_m = 3.0;  // chosen: within it a depth camera answers for a floor
constexpr double kEdge_m = 0.6;  // chosen: last part of a ray, over ground that was not seen
constexpr double kSteep = 0.2;   // chosen: a flatter ray meets the floor too far away
constexpr int kFrames = 3;       // chosen: as many as make a detection stable

bool HasAnswer(const Observation& obs, int u, int v) {
  if (!obs.depth_m.Contains(u, v)) return false;
  const float depth_m = obs.depth_m.At(u, v);
  return std::isfinite(depth_m) && depth_m > 0;
}

/// Whether no pixel of a square of 2 `reach` + 1 px gives a depth; single holes are noise.
bool IsHole(const Observation& obs, int u, int v, int reach) {
  for (int dv = -reach; dv <= reach; dv += std::max(1, reach))
    for (int du = -reach; du <= reach; du += std::max(1, reach))
      if (HasAnswer(obs, u + du, v + dv)) return false;
  return true;
}

bool IsKnownAir(VoxelMap::Cursor& cursor, const Vector3d& from_world, const Vector3d& to_world,
                double voxel_m) {
  const Vector3d ray = to_world - from_world;
  const int samples = std::max(1, static_cast<int>(std::ceil(ray.norm() / voxel_m)));
  for (int i = 0; i <= samples; ++i) {
    const auto state = cursor.At(geometry::KeyOf(from_world + ray * i / samples, voxel_m)).state;
    if (state == geometry::VoxelState::kUnknown || geometry::IsSurface(state)) return false;
  }
  return true;
}

}  // namespace

std::vector<VoxelKey> UnansweredGround::Look(const Observation& obs, const Vector3d& p_foot_world,
                                             const VoxelMap& map) {
  const double voxel_m = map.config().voxel_m;
  const Vector3d p_camera_world = obs.T_world_camera.translation();
  const int stride = std::max(1, obs.depth_m.width / kImageRays);
  std::set<VoxelKey> seen;
  VoxelMap::Cursor cursor(map);
  for (int v = stride / 2; v < obs.depth_m.height; v += stride)
    for (int u = stride / 2; u < obs.depth_m.width; u += stride) {
      if (HasAnswer(obs, u, v)) continue;
      const Vector3d ray = obs.T_world_camera.linear() * BackProjectPixel(obs.camera, u, v, 1.0F);
      const double flat = ray.head<2>().norm();
      if (ray.z() >= -kSteep * flat) continue;
      const double t = (p_foot_world.z() - p_camera_world.z()) / ray.z();
      if (t <= 0 || t * flat > kNear_m || !IsHole(obs, u, v, stride / 2)) continue;
      const Vector3d p_world = p_camera_world + t * ray;
      const double known = std::max(0.0, t - kEdge_m / std::max(flat, 1e-6));
      if (!IsKnownAir(cursor, p_camera_world, p_camera_world + known * ray, voxel_m)) continue;
      seen.insert(geometry::KeyOf(p_world + Vector3d(0, 0, 0.5 * voxel_m), voxel_m));
    }
  std::vector<VoxelKey> settled;
  for (const VoxelKey& key : seen)
    if (++frames_[key] == kFrames) settled.push_back(key);
  return settled;
}

}  // namespace crossnav::policy
