// SPDX-License-Identifier: MIT
// Scan since waking up, in the frame of the odometry (right-handed, z up, metres): points
// for matching, and beams for checking. Frames without depth add nothing. Deterministic.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/core/pose.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::localization {

/// The ray of one pixel, from the camera to the surface.
struct Beam {
  Vector3f p_eye_odom;
  Vector3f p_end_odom;
};

class LocalScan {
 public:
  /// `voxel_m`: at most one point is kept per voxel. Ignores depths beyond `reach_m`.
  LocalScan(double voxel_m, double reach_m) : voxel_m_(voxel_m), reach_m_(reach_m) {}

  /// Adds points and beams of a frame, on two grids of its pixels.
  void Add(const Observation& obs);

  const std::vector<Vector3f>& points_odom() const { return points_odom_; }
  const std::vector<Beam>& beams() const { return beams_; }
  int frames() const { return frames_; }  ///< with depth

 private:
  double voxel_m_, reach_m_;
  std::vector<Vector3f> points_odom_;
  std::vector<Beam> beams_;
  std::unordered_set<geometry::VoxelKey, geometry::VoxelKeyHash> taken_;
  int frames_ = 0;
};

/// At most `count` points, evenly drawn from a cylinder of radius `reach_m` about the foot, between
/// the two heights above the foot [m]; one per cell of `apart_m`.
struct PointChoice {
  Vector3d p_foot_odom = Vector3d::Zero();
  double reach_m = 6, low_m = 0.2, high_m = 2.2, apart_m = 0.2;
  int count = 240;
};
std::vector<Vector3f> ChoosePoints(const std::vector<Vector3f>& points, const PointChoice& choice);

}  // namespace crossnav::localization
