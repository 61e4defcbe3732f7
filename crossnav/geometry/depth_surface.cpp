// SPDX-License-Identifier: MIT
#include "crossnav/geometry/depth_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::geometry {
namespace {

// chosen: beyond, risers are noise
constexpr float kNearestRiser_m = 0.2F, kFarthestRiser_m = 5.0F;
constexpr double kStep_m = 0.15;         // chosen: neighbours farther apart lie on two things
constexpr double kLeastLevel_m2 = 0.15;  // chosen: smaller than two treads, the pose knows better

bool IsMeasured(float depth_m) {
  return depth_m >= kNearestRiser_m && depth_m <= kFarthestRiser_m;
}

}  // namespace

DepthSurface SurfaceOf(const DepthImage& depth_m, const CameraIntrinsics& camera,
                       const Pose& T_world_camera, const MaskImage& mask) {
  DepthSurface s{depth_m.width, depth_m.height, std::max(1, depth_m.width / 128), {}, {}, {}, {}};
  const std::size_t count = depth_m.data.size();
  s.p_world.resize(count);
  s.normal_world.assign(count, Vector3d::Zero());
  s.area_m2.assign(count, 0);
  s.is_measured.assign(count, false);
  for (int v = 0; v < s.height; ++v)
    for (int u = 0; u < s.width; ++u) {
      s.p_world[s.At(u, v)] = T_world_camera * BackProjectPixel(camera, u, v, depth_m.At(u, v));
      s.is_measured[s.At(u, v)] =
          IsMeasured(depth_m.At(u, v)) && (mask.empty() || mask.At(u, v) != 0);
    }
  const int reach = s.reach_px;
  for (int v = reach; v < s.height - reach; ++v)
    for (int u = reach; u < s.width - reach; ++u) {
      const int at = s.At(u, v);
      const std::array<int, 4> around = {s.At(u + reach, v), s.At(u - reach, v), s.At(u, v + reach),
                                         s.At(u, v - reach)};
      const bool is_known =
          s.is_measured[at] && std::all_of(around.begin(), around.end(),
                                           [&](int i) { return IsMeasured(depth_m.data[i]); });
      if (!is_known) continue;
      const Vector3d a = s.p_world[around[0]] - s.p_world[around[1]];
      const Vector3d b = s.p_world[around[2]] - s.p_world[around[3]];
      if (a.norm() > kStep_m || b.norm() > kStep_m) continue;
      const Vector3d n = a.cross(b);
      if (n.norm() <= 0) continue;
      const bool is_towards = n.dot(T_world_camera.translation() - s.p_world[at]) > 0;
      s.normal_world[at] = (is_towards ? 1 : -1) * n.normalized();
      s.area_m2[at] = n.norm() / (4.0 * reach * reach);
    }
  return s;
}

Vector3d UpOf(const DepthSurface& surface) {
  Vector3d up = Vector3d::UnitZ();
  for (const double within_deg : {20.0, 12.0, 8.0, 5.0, 5.0, 5.0}) {
    const double least = std::cos(DegToRad(within_deg));
    Vector3d sum = Vector3d::Zero();
    double area_m2 = 0;
    for (std::size_t i = 0; i < surface.area_m2.size(); ++i) {
      if (surface.normal_world[i].dot(up) < least) continue;
      sum += surface.area_m2[i] * surface.normal_world[i];
      area_m2 += surface.area_m2[i];
    }
    if (area_m2 < kLeastLevel_m2) return Vector3d::UnitZ();
    up = sum.normalized();
  }
  return up;
}

Eigen::Matrix3d LevelBy(const Pose& T_world_camera, DepthSurface* surface) {
  const Eigen::Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(UpOf(*surface), Vector3d::UnitZ()).toRotationMatrix();
  const Vector3d eye = T_world_camera.translation();
  for (Vector3d& p : surface->p_world) p = eye + R * (p - eye);
  for (Vector3d& n : surface->normal_world) n = R * n;
  return R;
}

}  // namespace crossnav::geometry
