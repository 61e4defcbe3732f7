// SPDX-License-Identifier: MIT
// The rays of a frame's pixels against single voxels, in double; cases within rounding are left to
// the literal arithmetic of ray_walk.h. Internal to the map.
#pragma once

#include "crossnav/geometry/integrate.h"

namespace crossnav::geometry {

class PixelRays {
 public:
  /// Of map.view's frame; all must outlive it.
  PixelRays(const MapData& map, const DepthFrame& frame);

  /// Does the ray of pixel (u, v) pass the voxel before it ends? As WalkRay would say.
  bool Passes(const VoxelKey& key, int u, int v) const;

  /// False if no ray between the rectangle's corner rays can meet the voxel.
  bool MayMeet(const VoxelKey& key, const PixelRect& rect) const;

  const Vector3d& start() const { return start_; }  ///< camera [voxels]
  const Vector3d& per_u() const { return per_u_; }  ///< ray(u, v) = forward + u per_u + v per_v
  const Vector3d& per_v() const { return per_v_; }  ///< [voxels per metre of depth]
  const Vector3d& forward() const { return forward_; }

 private:
  enum class Answer { kNo, kYes, kUnsure };
  Answer Ask(const VoxelKey& key, const Vector3d& ray, double reach_m) const;

  const MapData& map_;
  const DepthFrame& frame_;
  Vector3d start_, per_u_, per_v_, forward_;
  double parallel_ = 0;  ///< rays slower than this along an axis stay in one voxel
  double slack_m_ = 0;   ///< above rounding of a time of crossing
};

}  // namespace crossnav::geometry
