// SPDX-License-Identifier: MIT
// Axis-aligned rectangles of a floor plan [m].
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/core/rng.h"

namespace crossnav::world {

using Vector2d = Eigen::Vector2d;

struct Rect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  double Width() const { return x1 - x0; }
  double Depth() const { return y1 - y0; }
  double Area() const { return std::max(0.0, Width()) * std::max(0.0, Depth()); }
  Vector2d Center() const { return {0.5 * (x0 + x1), 0.5 * (y0 + y1)}; }
  bool Contains(const Vector2d& p) const {
    return p.x() >= x0 && p.x() <= x1 && p.y() >= y0 && p.y() <= y1;
  }
  /// A point drawn uniformly.
  Vector2d Draw(Rng& rng) const {
    const double y = rng.Uniform(y0, y1);
    return {rng.Uniform(x0, x1), y};
  }
  /// Grown on all sides; negative shrinks.
  Rect Grown(double by_m) const { return {x0 - by_m, y0 - by_m, x1 + by_m, y1 + by_m}; }
  Rect Shared(const Rect& o) const {
    return {std::max(x0, o.x0), std::max(y0, o.y0), std::min(x1, o.x1), std::min(y1, o.y1)};
  }
  bool Overlaps(const Rect& o, double tolerance_m = 1e-6) const {
    const Rect s = Shared(o);
    return s.Width() > tolerance_m && s.Depth() > tolerance_m;
  }
  friend bool operator==(const Rect&, const Rect&) = default;
};

/// `whole` without `holes`, as rectangles that do not overlap.
std::vector<Rect> Subtract(const Rect& whole, std::span<const Rect> holes);

}  // namespace crossnav::world
