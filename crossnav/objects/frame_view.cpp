// SPDX-License-Identifier: MIT
#include "crossnav/objects/frame_view.h"

#include <algorithm>
#include <cmath>

namespace crossnav::objects {
namespace {

constexpr double kSlack_vox = 2.0;  // chosen: a voxel's diagonal and the noise of depth
constexpr double kFront_vox = 1.2;  // chosen: likewise in front of it, and less than a wall
constexpr double kNear_m = 0.1;     // chosen: least depth in a picture

}  // namespace

FrameView ViewOf(std::span<const geometry::VoxelKey> voxels, const Observation& obs, double voxel_m,
                 int samples) {
  FrameView view;
  if (voxels.empty() || samples <= 0) return view;
  const Pose T_camera_world = obs.T_world_camera.inverse();
  const std::size_t step = std::max<std::size_t>(1, voxels.size() / samples);
  const double slack_m = kSlack_vox * voxel_m, front_m = kFront_vox * voxel_m;
  double u0 = 1e9, v0 = 1e9, u1 = -1e9, v1 = -1e9;
  int count = 0, free = 0, surface = 0, hidden = 0;
  view.distance_m = 1e9;
  for (std::size_t i = 0; i < voxels.size(); i += step) {
    ++count;
    const Vector3d p = T_camera_world * geometry::CenterOf(voxels[i], voxel_m);
    if (p.z() < kNear_m) continue;
    const double u = obs.camera.fx * p.x() / p.z() + obs.camera.cx;
    const double v = obs.camera.fy * p.y() / p.z() + obs.camera.cy;
    const int pu = static_cast<int>(std::lround(u)), pv = static_cast<int>(std::lround(v));
    if (!obs.depth_m.Contains(pu, pv)) continue;
    const float depth_m = obs.depth_m.At(pu, pv);
    if (!(depth_m > 0) || !std::isfinite(depth_m)) continue;
    view.distance_m = std::min(view.distance_m, p.norm());
    u0 = std::min(u0, u), u1 = std::max(u1, u), v0 = std::min(v0, v), v1 = std::max(v1, v);
    const double over_m = depth_m - p.z();
    if (over_m > slack_m)
      ++free;
    else if (over_m >= -front_m)
      ++surface;
    else
      ++hidden;
  }
  view.free = static_cast<double>(free) / count;
  view.surface = static_cast<double>(surface) / count;
  view.hidden = static_cast<double>(hidden) / count;
  if (u1 > u0 && v1 > v0) view.pixels = (u1 - u0) * (v1 - v0);
  return view;
}

}  // namespace crossnav::objects
