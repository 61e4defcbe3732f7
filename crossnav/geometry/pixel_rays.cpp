// SPDX-License-Identifier: MIT
#include "crossnav/geometry/pixel_rays.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {

PixelRays::PixelRays(const MapData& map, const DepthFrame& frame) : map_(map), frame_(frame) {
  const CameraIntrinsics& K = frame.camera;
  const Eigen::Matrix3d R = frame.T_world_camera.linear() / map.config.voxel_m;
  start_ = frame.T_world_camera.translation() / map.config.voxel_m;
  per_u_ = R.col(0) / K.fx;
  per_v_ = R.col(1) / K.fy;
  forward_ = R.col(2) - K.cx * per_u_ - K.cy * per_v_;
  const double reach_m = std::max(1.0, static_cast<double>(map.view.MaxReach()));
  parallel_ = 1e-7 / reach_m;
  slack_m_ = 1e-7 * reach_m * reach_m;
}

bool PixelRays::MayMeet(const VoxelKey& key, const PixelRect& rect) const {
  const std::array<int, 3> cell = {key.x, key.y, key.z};
  double enter = 0, leave = 1e300;
  for (int a = 0; a < 3; ++a) {
    const double d = forward_[a], u0 = per_u_[a] * rect.u0, u1 = per_u_[a] * rect.u1;
    const double v0 = per_v_[a] * rect.v0, v1 = per_v_[a] * rect.v1;
    const double d_lo = d + std::min(u0, u1) + std::min(v0, v1);
    const double d_hi = d + std::max(u0, u1) + std::max(v0, v1);
    const double lo = cell[a] - start_[a] - 1e-6, hi = cell[a] + 1 - start_[a] + 1e-6;
    if (lo > 0) {
      if (d_hi <= 0) return false;
      enter = std::max(enter, lo / d_hi);
      if (d_lo > 0) leave = std::min(leave, hi / d_lo);
    } else if (hi < 0) {
      if (d_lo >= 0) return false;
      enter = std::max(enter, hi / d_lo);
      if (d_hi < 0) leave = std::min(leave, lo / d_hi);
    } else {
      if (d_lo > 0) leave = std::min(leave, hi / d_lo);
      if (d_hi < 0) leave = std::min(leave, lo / d_hi);
    }
  }
  return enter <= leave + slack_m_;
}

bool PixelRays::Passes(const VoxelKey& key, int u, int v) const {
  const double reach_m = map_.view.ReachAt(u, v);
  if (reach_m == 0) return false;
  const Answer answer = Ask(key, forward_ + per_u_ * u + per_v_ * v, reach_m);
  if (answer != Answer::kUnsure) return answer == Answer::kYes;
  const DepthReach literal =
      ReachOf(frame_.depth_m.At(u, v), map_.config.depth_min_m, map_.config.depth_max_m);
  const Vector3d end = BackProjectToVoxels(frame_.camera, frame_.T_world_camera, u, v,
                                           literal.depth_m, map_.config.voxel_m);
  return RayPasses(start_, end, key);
}

/// The ray against the voxel's faces, with room for rounding.
PixelRays::Answer PixelRays::Ask(const VoxelKey& key, const Vector3d& ray, double reach_m) const {
  const std::array<int, 3> cell = {key.x, key.y, key.z};
  double enter = 0, leave = reach_m + 1;
  bool is_unsure = false;
  for (int a = 0; a < 3; ++a) {
    const double lo = cell[a] - start_[a], hi = lo + 1;
    if (std::abs(ray[a]) < parallel_) {
      if (lo > 1e-6 || hi < -1e-6) return Answer::kNo;
      is_unsure = true;
      continue;
    }
    const double inverse = 1 / ray[a];
    const double t0 = lo * inverse, t1 = hi * inverse;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (leave < enter - slack_m_ || reach_m < leave - slack_m_) return Answer::kNo;
  const bool is_sure = leave > enter + slack_m_ && reach_m > leave + slack_m_;
  return is_sure && !is_unsure ? Answer::kYes : Answer::kUnsure;
}

}  // namespace crossnav::geometry
