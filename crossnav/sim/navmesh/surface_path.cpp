// SPDX-License-Identifier: MIT
#include "crossnav/sim/navmesh/surface_path.h"

#include <algorithm>
#include <cmath>

namespace crossnav::sim {
namespace {

constexpr double kSample_m = 0.05;      // chosen: finer than a tread
constexpr int kSmooth = 6;              // samples to each side: 0.3 m, so that treads become a ramp
constexpr double kHeightError_m = 0.1;  // chosen: half a riser

/// Appends the points of (first, last) whose height departs from the straight line, in order.
// NOLINTNEXTLINE(misc-no-recursion): every call has fewer points
void AddBends(const std::vector<PathPoint>& points, std::size_t first, std::size_t last,
              std::vector<Vector3d>& out) {
  const Vector3d& a = points[first].p;
  const Vector3d& b = points[last].p;
  const double length = std::max((b - a).head<2>().norm(), 1e-9);
  std::size_t worst = first;
  double worst_m = kHeightError_m;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double share = (points[i].p - a).head<2>().norm() / length;
    const double off_m = std::abs(a.z() + share * (b.z() - a.z()) - points[i].p.z());
    if (off_m <= worst_m) continue;
    worst_m = off_m;
    worst = i;
  }
  if (worst == first) return;
  AddBends(points, first, worst, out);
  out.push_back(points[worst].p);
  AddBends(points, worst, last, out);
}

/// Heights at equal steps along the path, both ends included.
std::vector<double> SampleHeights(const dtNavMeshQuery& query, const WalkPath& path, double start_z,
                                  std::size_t count) {
  std::vector<double> heights{start_z};
  const double step_m = path.plan_length_m / static_cast<double>(count);
  double before_m = 0;  // length of the pieces already passed
  for (const PathPiece& piece : path.pieces) {
    const double length = (piece.to - piece.from).norm();
    while (heights.size() < count) {
      const double along_m = static_cast<double>(heights.size()) * step_m - before_m;
      if (along_m > length) break;
      const Vector2d p = piece.from + (piece.to - piece.from) * (along_m / length);
      const RecastPoint at = RecastFromWorld({p.x(), p.y(), heights.back()});
      RecastPoint on_polygon = at;
      query.closestPointOnPoly(piece.ref, at.data(), on_polygon.data(), nullptr);
      heights.push_back(on_polygon[1]);
    }
    before_m += length;
  }
  heights.resize(count + 1, heights.back());
  return heights;
}

/// Mean over a window that shrinks towards the ends, so that these stay where they are.
std::vector<double> Smooth(const std::vector<double>& heights) {
  std::vector<double> out(heights.size());
  const int n = static_cast<int>(heights.size());
  for (int i = 0; i < n; ++i) {
    const int reach = std::min({kSmooth, i, n - 1 - i});
    double sum = 0;
    for (int k = i - reach; k <= i + reach; ++k) sum += heights[static_cast<std::size_t>(k)];
    out[static_cast<std::size_t>(i)] = sum / (2 * reach + 1);
  }
  return out;
}

}  // namespace

std::vector<PathPoint> LiftPath(const dtNavMeshQuery& query, const WalkPath& path,
                                const Vector3d& a, const Vector3d& b) {
  const double total_m = path.plan_length_m;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(total_m / kSample_m)));
  std::vector<double> heights = SampleHeights(query, path, a.z(), count);
  heights.back() = b.z();
  heights = Smooth(heights);
  const auto height_at = [&](double s_m) {
    const double at = std::clamp(s_m / total_m, 0.0, 1.0) * static_cast<double>(count);
    const auto i = std::min(static_cast<std::size_t>(at), count - 1);
    const double share = at - static_cast<double>(i);
    return heights[i] + share * (heights[i + 1] - heights[i]);
  };
  std::vector<PathPoint> points{{a, true}};
  const double step_m = total_m / static_cast<double>(count);
  std::size_t sample = 1;
  double before_m = 0;
  for (std::size_t c = 1; c < path.corners.size(); ++c) {
    const Vector2d &from = path.corners[c - 1], &to = path.corners[c];
    const double length = (to - from).norm();
    for (; sample < count; ++sample) {
      const double s_m = static_cast<double>(sample) * step_m;
      if (s_m >= before_m + length) break;
      const Vector2d p = from + (to - from) * ((s_m - before_m) / length);
      points.push_back({{p.x(), p.y(), height_at(s_m)}, false});
    }
    before_m += length;
    if (c + 1 < path.corners.size()) {
      points.push_back({{to.x(), to.y(), height_at(before_m)}, true});
    }
  }
  points.push_back({b, true});
  return points;
}

std::vector<Vector3d> KeepShape(const std::vector<PathPoint>& points) {
  std::vector<Vector3d> out{points.front().p};
  std::size_t last_corner = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!points[i].is_corner) continue;
    AddBends(points, last_corner, i, out);
    out.push_back(points[i].p);
    last_corner = i;
  }
  return out;
}

}  // namespace crossnav::sim
