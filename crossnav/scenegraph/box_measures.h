// SPDX-License-Identifier: MIT
// Measures of two boxes for relations between objects, and their limits. World frame, metres.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "crossnav/core/box.h"

namespace crossnav::scenegraph {

inline constexpr double kTouch_m = 0.15;  // chosen: a voxel and a half between two surfaces
inline constexpr double kNextTo_m = 0.5;  // chosen: too narrow to walk between
inline constexpr double kNear_m = 1.5;    // chosen: within an arm and a step
inline constexpr double kCovered = 0.5;   // chosen: share of the upper object's ground plan

/// Box of surfaces in voxels that `voxels` encloses, half a voxel smaller on each side: a surface
/// lies anywhere in its voxel, so that the voxels alone are too large by half a voxel on average.
inline Box3 SurfaceBoxOf(const Eigen::AlignedBox3d& voxels, double voxel_m) {
  constexpr double kLeast_m = 0.02;  // chosen: a picture on a wall
  const Vector3d spare_m = ((voxels.sizes().array() - kLeast_m) / 2).max(0.0);
  const Vector3d inset_m = spare_m.array().min(voxel_m / 2);
  return {voxels.min() + inset_m, voxels.max() - inset_m};
}

/// Overlap along an axis [m]; negative: the gap.
inline double OverlapOf(const Box3& a, const Box3& b, int axis) {
  return std::min(a.max[axis], b.max[axis]) - std::max(a.min[axis], b.min[axis]);
}

/// Share of the ground plan of `a` that lies over the plan of `b` [0, 1].
inline double CoverOf(const Box3& a, const Box3& b) {
  const double dx = std::max(0.0, OverlapOf(a, b, 0)), dy = std::max(0.0, OverlapOf(a, b, 1));
  const Vector3d size = a.max - a.min;
  return size.x() * size.y() > 0 ? dx * dy / (size.x() * size.y()) : 0;
}

/// Horizontal gap between both ground plans [m]; 0 where they overlap.
inline double GapOf(const Box3& a, const Box3& b) {
  return std::hypot(std::max(0.0, -OverlapOf(a, b, 0)), std::max(0.0, -OverlapOf(a, b, 1)));
}

}  // namespace crossnav::scenegraph
