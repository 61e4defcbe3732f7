// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/held_out.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "crossnav/geometry/map_queries.h"
#include "crossnav/geometry/ray_walk.h"
#include "crossnav/geometry/surface_plane.h"

namespace crossnav::evaluation {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;
using geometry::VoxelState;

constexpr int kRay_px = 4;  // chosen: neighbouring rays carry the same information

/// Fractions of the segment at entry into and exit from the voxel.
std::pair<double, double> ThroughVoxel(const Vector3d& from, const Vector3d& to,
                                       const VoxelKey& key) {
  double enter = 0, leave = 1;
  const double low[3] = {double(key.x), double(key.y), double(key.z)};
  for (int a = 0; a < 3; ++a) {
    const double way = to[a] - from[a];
    if (std::abs(way) < 1e-12) continue;
    const double t0 = (low[a] - from[a]) / way, t1 = (low[a] + 1 - from[a]) / way;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return {enter, leave};
}

constexpr double kGrazing = 0.1;  // chosen: sine; a flatter ray meets a plane anywhere
constexpr double kBehind_vox =
    3;  // chosen: of the plane behind the first voxel, as it is made of two

/// Share of the segment at which it meets the surface whose first voxel is `key`.
double MeetingShare(const VoxelMap& map, const Vector3d& from, const Vector3d& to,
                    const VoxelKey& key) {
  const auto [enter, leave] = ThroughVoxel(from, to, key);
  const auto plane = geometry::PlaneAround(map, key);
  const Vector3d way = to - from;
  const double towards = plane ? plane->normal_world.dot(way) : 0;
  if (std::abs(towards) <= kGrazing * way.norm()) return 0.5 * (enter + leave);
  const Vector3d p = plane->p_world / map.config().voxel_m;
  const double share = plane->normal_world.dot(p - from) / towards;
  return std::clamp(share, enter, leave + kBehind_vox / way.norm());
}

/// Depth at which the map has a surface on the pixel's ray.
std::optional<double> PredictedDepth(const VoxelMap& map, const Observation& obs, int u, int v) {
  const double voxel_m = map.config().voxel_m, far_m = map.config().depth_max_m;
  const Vector3d from = obs.T_world_camera.translation() / voxel_m;
  const Vector3d to = obs.T_world_camera * BackProjectPixel(obs.camera, u, v, far_m) / voxel_m;
  VoxelMap::Cursor cursor(map);
  std::optional<double> depth_m;
  bool has_begun = false;  // the sensor is blind near the camera: unknown voxels before the first
                           // known voxel are allowed
  geometry::WalkRay(from, to, [&](const VoxelKey& key) {
    const VoxelState state = cursor.At(key).state;
    if (state == VoxelState::kUnknown) return !has_begun;
    has_begun = true;
    if (!IsSurface(state)) return true;
    depth_m = MeetingShare(map, from, to, key) * far_m;
    return false;
  });
  return depth_m;
}

bool IsFreeAround(const VoxelMap& map, const VoxelKey& key) {
  bool is_free = true;
  geometry::ForEachNeighbour26(map, key, [&](const VoxelKey&, const geometry::Voxel& voxel) {
    is_free = is_free && !IsSurface(voxel.state);
  });
  return is_free;
}

}  // namespace

void AddHeldOut(const VoxelMap& map, const Observation& obs, HeldOutResult* result) {
  const geometry::MapConfig& config = map.config();
  for (int v = kRay_px / 2; v < obs.depth_m.height; v += kRay_px)
    for (int u = kRay_px / 2; u < obs.depth_m.width; u += kRay_px) {
      const double depth_m = obs.depth_m.At(u, v);
      if (!(depth_m >= config.depth_min_m && depth_m <= config.depth_max_m)) continue;
      ++result->rays;
      const Vector3d p_world = obs.T_world_camera * BackProjectPixel(obs.camera, u, v, depth_m);
      const VoxelKey end = geometry::KeyOf(p_world, config.voxel_m);
      const VoxelState state = map.StateAt(end);
      if (state != VoxelState::kUnknown) {
        ++result->known;
        result->violations += !IsSurface(state) && IsFreeAround(map, end);
      }
      const auto predicted_m = PredictedDepth(map, obs, u, v);
      if (predicted_m) result->errors_m.push_back(std::abs(*predicted_m - depth_m));
    }
}

}  // namespace crossnav::evaluation
