// SPDX-License-Identifier: MIT
// Derives railings from the plan: every edge of a void without a wall or a stair needs a railing.
#include <algorithm>
#include <cmath>

#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {
namespace {

constexpr double kOn_m = 0.13;  // chosen: edge and wall (or stair) count as one below this

/// True if `p` lies on the axis-aligned line a-b, within `tolerance_m` across it.
bool IsOn(const Vector2d& p, const Edge& e, double tolerance_m) {
  const Rect box{std::min(e.a.x(), e.b.x()), std::min(e.a.y(), e.b.y()), std::max(e.a.x(), e.b.x()),
                 std::max(e.a.y(), e.b.y())};
  const bool is_vertical = box.Width() < box.Depth();
  const Rect near = is_vertical ? Rect{box.x0 - tolerance_m, box.y0, box.x1 + tolerance_m, box.y1}
                                : Rect{box.x0, box.y0 - tolerance_m, box.x1, box.y1 + tolerance_m};
  return near.Contains(p);
}

struct LevelEdges {
  std::vector<Rect> voids;
  std::vector<Edge> walls;
  std::vector<Edge> openings;  ///< where stairs arrive or depart
};

LevelEdges EdgesOf(const HousePlan& plan, int level) {
  LevelEdges edges;
  edges.voids = plan.VoidsOf(level);
  for (const Wall& wall : plan.walls) {
    if (wall.level == level) edges.walls.push_back({wall.a, wall.b});
  }
  for (const Stair& stair : plan.stairs) {
    if (stair.voids.empty()) continue;
    if (stair.upper_level == level) {
      edges.openings.insert(edges.openings.end(), stair.arrivals.begin(), stair.arrivals.end());
    }
    if (stair.lower_level == level) {
      edges.openings.insert(edges.openings.end(), stair.departures.begin(), stair.departures.end());
    }
  }
  return edges;
}

bool NeedsRail(const Vector2d& p, const Vector2d& outward, const LevelEdges& edges) {
  const Vector2d outside = p + 0.02 * outward;
  for (const Rect& r : edges.voids) {
    if (r.Grown(1e-6).Contains(outside)) return false;
  }
  for (const Edge& w : edges.walls) {
    if (IsOn(p, w, kOn_m)) return false;
  }
  // A stair's edge may lie a few treads inside the void (headroom): the search extends beyond it.
  return std::none_of(edges.openings.begin(), edges.openings.end(), [&](const Edge& e) {
    const Vector2d along = (e.b - e.a).normalized();
    return std::abs(along.dot(outward)) < 0.1 && IsOn(p, e, 0.75);
  });
}

/// Coordinates at which the need for a rail may change along an edge.
std::vector<double> Breaks(double lo, double hi, bool along_x, const LevelEdges& edges) {
  std::vector<double> at = {lo, hi};
  const auto add = [&](const Vector2d& p) {
    const double v = along_x ? p.x() : p.y();
    if (v > lo && v < hi) at.push_back(v);
  };
  for (const Rect& r : edges.voids) {
    add({r.x0, r.y0});
    add({r.x1, r.y1});
  }
  for (const auto* list : {&edges.walls, &edges.openings}) {
    for (const Edge& e : *list) {
      add(e.a);
      add(e.b);
    }
  }
  std::sort(at.begin(), at.end());
  return at;
}

/// A side of a void.
struct VoidSide {
  bool along_x;
  double fixed;
  Vector2d outward;

  Vector2d At(double v) const { return along_x ? Vector2d(v, fixed) : Vector2d(fixed, v); }
};

void RailSide(const Rect& r, const VoidSide& side, const LevelEdges& edges, double z_m, int style,
              HousePlan& plan) {
  constexpr double kSetback_m = 0.04;  // the posts stand on the floor, not over the void
  const auto at = side.along_x ? Breaks(r.x0, r.x1, true, edges) : Breaks(r.y0, r.y1, false, edges);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (at[i + 1] - at[i] < 0.05) continue;
    if (!NeedsRail(side.At(0.5 * (at[i] + at[i + 1])), side.outward, edges)) continue;
    const Vector2d a = side.At(at[i]) + kSetback_m * side.outward;
    const Vector2d b = side.At(at[i + 1]) + kSetback_m * side.outward;
    plan.railings.push_back({{a.x(), a.y(), z_m}, {b.x(), b.y(), z_m}, 0.95, style});
  }
}

}  // namespace

void RailVoids(HousePlan& plan, int style) {
  for (int level = 0; level < static_cast<int>(plan.levels.size()); ++level) {
    const LevelEdges edges = EdgesOf(plan, level);
    const double z_m = plan.levels[static_cast<std::size_t>(level)].floor_m;
    for (const Rect& r : edges.voids) {
      const VoidSide sides[] = {{true, r.y0, {0, -1}},
                                {true, r.y1, {0, 1}},
                                {false, r.x0, {-1, 0}},
                                {false, r.x1, {1, 0}}};
      for (const VoidSide& side : sides) RailSide(r, side, edges, z_m, style, plan);
    }
  }
}

}  // namespace crossnav::world
