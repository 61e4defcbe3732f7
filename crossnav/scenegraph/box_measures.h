// SPDX-License-Identifier: MIT
// Measures of two boxes for relations between objects, and their limits. World frame, metres.
#pragma once

#include <algorithm>
#include <cmath>

#include "crossnav/core/box.h"

namespace crossnav::scenegraph {

inline constexpr double kTouch_m = 0.15;  // chosen: a voxel and a half between two surfaces
inline constexpr double kNextTo_m = 0.5;  // chosen: too narrow to walk between
inline constexpr double kNear_m = 1.5;    // chosen: within an arm and a step
inline constexpr double kCovered = 0.5;   // chosen: share of the upper object's ground plan

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
