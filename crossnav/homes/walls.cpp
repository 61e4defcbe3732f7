// SPDX-License-Identifier: MIT
// Cuts walls into upright columns along their centre line: at every corner of an arc and at both
// jambs of every opening. A column is solid outside its openings.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "crossnav/homes/shell.h"

namespace crossnav::homes {
namespace {

constexpr double kArcStep_rad = 0.15;   // chosen: 5 mm off the arc at a radius of 2 m
constexpr double kMinOverlap_m = 0.02;  // chosen: of an opening with a wall
constexpr double kThreshold_m = 0.004;  // chosen: too low to see, enough to tell surfaces apart
constexpr Rgb8 kWallColour{232, 230, 224};

Vector2d LeftNormal(const Vector2d& from, const Vector2d& to) {
  const Vector2d d = (to - from).normalized();
  return {-d.y(), d.x()};
}

/// Where the lines through p along d and through q along e meet.
std::optional<Vector2d> Meet(const Vector2d& p, const Vector2d& d, const Vector2d& q,
                             const Vector2d& e) {
  const double det = d.x() * e.y() - d.y() * e.x();
  if (std::abs(det) < 1e-3 * d.norm() * e.norm()) return std::nullopt;
  const Vector2d w = q - p;
  return Vector2d(p + d * ((w.x() * e.y() - w.y() * e.x()) / det));
}

/// Corners of a wall seen from above: a left and a right corner at each point of its centre line.
struct Outline {
  std::vector<Vector2d> centre, left, right;
};

Outline OutlineOf(const HomeWall& wall) {
  Outline o;
  o.centre = CentreLine(wall);
  const double half = 0.5 * wall.thickness_m;
  for (std::size_t i = 0; i < o.centre.size(); ++i) {
    Vector2d n = Vector2d::Zero();
    if (i > 0) n += LeftNormal(o.centre[i - 1], o.centre[i]);
    if (i + 1 < o.centre.size()) n += LeftNormal(o.centre[i], o.centre[i + 1]);
    n /= std::max(0.5 * n.squaredNorm() * (i > 0 && i + 1 < o.centre.size() ? 1.0 : 2.0), 0.25);
    o.left.emplace_back(o.centre[i] + half * n);
    o.right.emplace_back(o.centre[i] - half * n);
  }
  return o;
}

/// Moves the corners at one end of `wall` onto the sides of the joined wall.
void Mitre(const HomeWall& wall, bool at_end, const HomeWall& other, Outline& o) {
  const std::size_t end = at_end ? o.centre.size() - 1 : 0;
  const std::size_t inner = at_end ? end - 1 : 1;
  const Vector2d along = o.centre[end] - o.centre[inner];
  const Outline theirs = OutlineOf(other);
  const bool from_start = (theirs.centre.front() - o.centre[end]).norm() <
                          (theirs.centre.back() - o.centre[end]).norm();
  const std::size_t n = theirs.centre.size();
  const std::size_t near = from_start ? 0 : n - 1, far = from_start ? 1 : n - 2;
  const Vector2d their_direction = theirs.centre[far] - theirs.centre[near];
  // Left stays left along the joined walls.
  const bool same_side = at_end == from_start;
  const auto& on_left = same_side ? theirs.left : theirs.right;
  const auto& on_right = same_side ? theirs.right : theirs.left;
  const double limit = 2 * std::max(wall.thickness_m, other.thickness_m);
  const auto move = [&](Vector2d& corner, const Vector2d& on_other) {
    const auto p = Meet(corner, along, on_other, their_direction);
    if (p && (*p - corner).norm() <= limit) corner = *p;
  };
  move(o.left[end], on_left[near]);
  move(o.right[end], on_right[near]);
}

struct Hole {
  double s0 = 0, s1 = 0;  ///< along the part of the wall [m]
  double z0 = 0, z1 = 0;
};

/// Holes of the home's openings in the part of a wall between two points.
std::vector<Hole> HolesIn(const HomePlan& plan, const Vector2d& a, const Vector2d& b,
                          double thickness_m, bool is_arc) {
  std::vector<Hole> holes;
  const Vector2d d = (b - a).normalized();
  const Vector2d side = Vector2d(-d.y(), d.x()) * (0.5 * thickness_m);
  const Polygon part = {a - side, b - side, b + side, a + side};
  for (const HomePiece& piece : plan.pieces) {
    if (piece.kind != PieceKind::kOpening) continue;
    const Vector2d across = OnPlan(piece, 1, 0) - piece.center;
    const double turned = std::abs(d.x() * across.y() - d.y() * across.x());
    if (turned > (is_arc ? 0.75 : 0.35)) continue;  // not parallel to the wall
    const double x = 0.5 * piece.width_m;
    const double y1 = (0.5 - piece.wall_from) * piece.depth_m;
    const double y0 = (0.5 - std::max(piece.wall_to, piece.wall_from + 0.01)) * piece.depth_m;
    const Polygon foot = {OnPlan(piece, -x, y0), OnPlan(piece, x, y0), OnPlan(piece, x, y1),
                          OnPlan(piece, -x, y1)};
    const Polygon shared = Shared(part, foot);
    if (shared.empty()) continue;
    Hole hole{1e9, -1e9, plan.FloorOf(piece.level) + piece.bottom_m, 0};
    hole.z1 = hole.z0 + piece.height_m;
    // A threshold just below the floors that may lie over it.
    if (std::abs(piece.bottom_m) < 0.01) hole.z0 -= kThreshold_m;
    double n0 = 1e9, n1 = -1e9;
    for (const Vector2d& p : shared) {
      const double s = (p - a).dot(d), n = (p - a).dot(side.normalized());
      hole.s0 = std::min(hole.s0, s);
      hole.s1 = std::max(hole.s1, s);
      n0 = std::min(n0, n);
      n1 = std::max(n1, n);
    }
    if (hole.s1 - hole.s0 < kMinOverlap_m || n1 - n0 < std::min(kMinOverlap_m, thickness_m / 3)) {
      continue;
    }
    holes.push_back(hole);
  }
  return holes;
}

/// A straight part of a wall, with its four corners.
struct WallPart {
  Vector2d a, b;  // centre line
  Vector2d left_a, left_b, right_a, right_b;
  double bottom = 0, top_a = 0, top_b = 0;  // heights
};

class PartBuilder {
 public:
  PartBuilder(const HomeWall& wall, const WallPart& part, const UseFinish& use,
              world::SceneBuilder& scene)
      : wall_(wall), part_(part), use_(use), scene_(scene) {}

  void Build(const std::vector<Hole>& holes) {
    const double length = (part_.b - part_.a).norm();
    const Vector2d d = (part_.b - part_.a) / length;
    const auto s_of = [&](const Vector2d& p) { return (p - part_.a).dot(d); };
    // Openings end where the corner of the wall begins.
    const double low = std::max(s_of(part_.left_a), s_of(part_.right_a)) + 0.001;
    const double high = std::min(s_of(part_.left_b), s_of(part_.right_b)) - 0.001;
    std::vector<double> cuts;
    for (const Hole& hole : holes) {
      for (const double s : {hole.s0, hole.s1}) {
        if (s > low && s < high) cuts.push_back(s);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    double from = -1e9;
    for (std::size_t i = 0; i <= cuts.size(); ++i) {
      const double to = i < cuts.size() ? cuts[i] : 1e9;
      const double s0 = i == 0 ? low : from, s1 = i == cuts.size() ? high : to;
      if (to - from > 1e-4) Column(i == 0, i == cuts.size(), s0, s1, holes);
      from = to;
    }
  }

 private:
  void Column(bool is_first, bool is_last, double s0, double s1, const std::vector<Hole>& holes) {
    const double length = (part_.b - part_.a).norm();
    const Vector2d d = (part_.b - part_.a) / length;
    const Vector2d left = Vector2d(-d.y(), d.x()) * (0.5 * wall_.thickness_m);
    WallPart column = part_;
    const auto top = [&](double s) {
      return part_.top_a + (part_.top_b - part_.top_a) * std::clamp(s / length, 0.0, 1.0);
    };
    if (!is_first) {
      column.left_a = part_.a + d * s0 + left;
      column.right_a = part_.a + d * s0 - left;
      column.top_a = top(s0);
    }
    if (!is_last) {
      column.left_b = part_.a + d * s1 + left;
      column.right_b = part_.a + d * s1 - left;
      column.top_b = top(s1);
    }
    std::vector<std::pair<double, double>> taken;
    const double middle = 0.5 * (s0 + s1);
    for (const Hole& hole : holes) {
      if (hole.s0 <= middle && hole.s1 >= middle) taken.emplace_back(hole.z0, hole.z1);
    }
    std::sort(taken.begin(), taken.end());
    double z = part_.bottom;
    for (const auto& [z0, z1] : taken) {
      if (z0 > z) Solid(column, z, z0);
      z = std::max(z, z1);
    }
    Solid(column, z, 1e9);
  }

  /// Adds a solid from `low` to `high` or to the sloping top, whichever is lower.
  void Solid(const WallPart& c, double low, double high) {
    const double za = std::min(high, c.top_a), zb = std::min(high, c.top_b);
    if (std::max(za, zb) - low < 1e-3) return;
    const auto at = [&](const Vector2d& p, double z) {
      return Vector3d(p.x(), p.y(), std::max(z, low));
    };
    auto& mesh = scene_.mesh;
    use_(wall_.left, kWallColour);
    mesh.AddQuad(at(c.left_b, low), at(c.left_a, low), at(c.left_a, za), at(c.left_b, zb));
    mesh.AddQuad(at(c.left_a, low), at(c.right_a, low), at(c.right_a, za), at(c.left_a, za));
    mesh.AddQuad(at(c.right_b, low), at(c.left_b, low), at(c.left_b, zb), at(c.right_b, zb));
    mesh.AddQuad(at(c.right_a, za), at(c.right_b, zb), at(c.left_b, zb), at(c.left_a, za));
    mesh.AddQuad(at(c.left_a, low), at(c.left_b, low), at(c.right_b, low), at(c.right_a, low));
    use_(wall_.right, kWallColour);
    mesh.AddQuad(at(c.right_a, low), at(c.right_b, low), at(c.right_b, zb), at(c.right_a, za));
  }

  const HomeWall& wall_;
  const WallPart& part_;
  const UseFinish& use_;
  world::SceneBuilder& scene_;
};

void BuildWall(const HomePlan& plan, const HomeWall& wall, const UseFinish& use,
               world::SceneBuilder& scene) {
  Outline o = OutlineOf(wall);
  const auto joined = [&](int index, bool at_end) {
    if (index >= 0) Mitre(wall, at_end, plan.walls[static_cast<std::size_t>(index)], o);
  };
  joined(wall.at_start, false);
  joined(wall.at_end, true);
  const HomeLevel& level = plan.levels[static_cast<std::size_t>(wall.level)];
  const auto top = [&](double height_m) {
    const bool reaches_ceiling = std::abs(height_m - level.height_m) < 0.01;
    return level.floor_m + height_m +
           (reaches_ceiling ? (1 - kFloorShare) * SlabAbove(plan, wall.level) : 0);
  };
  const double z0 = top(wall.height_m), z1 = top(wall.height_at_end_m);
  const auto parts = static_cast<double>(o.centre.size() - 1);
  for (std::size_t i = 0; i + 1 < o.centre.size(); ++i) {
    const auto k = static_cast<double>(i);
    const WallPart part{o.centre[i],
                        o.centre[i + 1],
                        o.left[i],
                        o.left[i + 1],
                        o.right[i],
                        o.right[i + 1],
                        level.floor_m - kFloorShare * level.slab_m,
                        z0 + (z1 - z0) * k / parts,
                        z0 + (z1 - z0) * (k + 1) / parts};
    const bool is_arc = o.centre.size() > 2;
    PartBuilder(wall, part, use, scene)
        .Build(HolesIn(plan, part.a, part.b, wall.thickness_m, is_arc));
  }
}

}  // namespace

std::vector<Vector2d> CentreLine(const HomeWall& wall) {
  if (std::abs(wall.arc_rad) < 0.01) return {wall.a, wall.b};
  const double length = (wall.b - wall.a).norm();
  const Vector2d center =
      0.5 * (wall.a + wall.b) +
      LeftNormal(wall.a, wall.b) * (0.5 * length / std::tan(0.5 * wall.arc_rad));
  const int parts = std::max(2, static_cast<int>(std::ceil(std::abs(wall.arc_rad) / kArcStep_rad)));
  std::vector<Vector2d> line;
  for (int i = 0; i <= parts; ++i) {
    line.emplace_back(center +
                      Eigen::Rotation2Dd(wall.arc_rad * i / parts) * Vector2d(wall.a - center));
  }
  return line;
}

void BuildWalls(const HomePlan& plan, const UseFinish& use, world::SceneBuilder& scene) {
  for (const HomeWall& wall : plan.walls) {
    const Vector2d middle = 0.5 * (wall.a + wall.b);
    const Vector2d reach = LeftNormal(wall.a, wall.b) * (0.5 * wall.thickness_m + 0.1);
    const int left = RoomAt(plan, wall.level, middle + reach);
    const int right = RoomAt(plan, wall.level, middle - reach);
    scene.BeginInstance("wall", std::max({left, right, 0}));
    BuildWall(plan, wall, use, scene);
  }
}

}  // namespace crossnav::homes
