// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "crossnav/core/pose.h"

namespace crossnav {

/// Axis-aligned box in the world frame [m]; empty while min > max.
struct Box3 {
  Vector3d min = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d max = Vector3d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return (min.array() > max.array()).any(); }
  Vector3d Center() const { return 0.5 * (min + max); }
  void Add(const Vector3d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  /// Distance from `p` to the box in the horizontal plane, 0 inside [m].
  double HorizontalDistance(const Vector3d& p) const {
    const double dx = std::max({min.x() - p.x(), 0.0, p.x() - max.x()});
    const double dy = std::max({min.y() - p.y(), 0.0, p.y() - max.y()});
    return std::hypot(dx, dy);
  }
};

}  // namespace crossnav
