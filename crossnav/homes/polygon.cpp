// SPDX-License-Identifier: MIT
#include "crossnav/homes/polygon.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace crossnav::homes {
namespace {

constexpr double kSame_m = 1e-4;       // chosen: points closer than this are one
constexpr double kMinPiece_m2 = 1e-5;  // chosen: slivers below 10 mm2 are dropped

double Cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Twice the area of the triangle, > 0 where c lies on the left of a -> b.
double Turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return Cross(b - a, c - a);
}

bool IsInTriangle(const Vector2d& p, const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return Turn(a, b, p) >= 0 && Turn(b, c, p) >= 0 && Turn(c, a, p) >= 0;
}

bool IsEar(const Polygon& rest, std::size_t i) {
  const std::size_t n = rest.size();
  const Vector2d &a = rest[(i + n - 1) % n], &b = rest[i], &c = rest[(i + 1) % n];
  if (Turn(a, b, c) <= 0) return false;
  for (const Vector2d& p : rest) {
    if (p == a || p == b || p == c) continue;
    if (IsInTriangle(p, a, b, c)) return false;
  }
  return true;
}

}  // namespace

double SignedArea(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * twice;
}

Polygon Cleaned(const Polygon& polygon) {
  Polygon out = polygon;
  for (bool changed = true; changed && out.size() >= 3;) {
    changed = false;
    for (std::size_t i = 0; i < out.size() && out.size() >= 3;) {
      const std::size_t n = out.size();
      const Vector2d &a = out[(i + n - 1) % n], &b = out[i], &c = out[(i + 1) % n];
      const double length = (c - a).norm();
      const bool is_same = (b - a).norm() < kSame_m;
      const bool is_straight = std::abs(Turn(a, b, c)) < 1e-7 * std::max(length, kSame_m);
      if (is_same || is_straight) {
        out.erase(out.begin() + static_cast<std::ptrdiff_t>(i));
        changed = true;
      } else {
        ++i;
      }
    }
  }
  if (out.size() < 3 || std::abs(SignedArea(out)) < kMinPiece_m2) return {};
  if (SignedArea(out) < 0) std::reverse(out.begin(), out.end());
  return out;
}

std::vector<Polygon> Triangulate(const Polygon& polygon) {
  Polygon rest = Cleaned(polygon);
  std::vector<Polygon> triangles;
  while (rest.size() >= 3) {
    const std::size_t n = rest.size();
    std::size_t ear = 0;
    while (ear < n && !IsEar(rest, ear)) ++ear;
    if (ear == n) {  // crosses itself: drops a corner
      ear = 0;
    } else {
      triangles.push_back({rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
    }
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

Polygon LeftOf(const Polygon& piece, const Vector2d& a, const Vector2d& b) {
  Polygon out;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vector2d &p = piece[i], &q = piece[(i + 1) % piece.size()];
    const double tp = Turn(a, b, p), tq = Turn(a, b, q);
    if (tp >= 0) out.push_back(p);
    if ((tp > 0 && tq < 0) || (tp < 0 && tq > 0)) out.push_back(p + (q - p) * (tp / (tp - tq)));
  }
  return out.size() < 3 || SignedArea(out) < kMinPiece_m2 ? Polygon{} : out;
}

std::vector<Eigen::Vector3d> SideOf(const std::vector<Eigen::Vector3d>& polygon, Eigen::Index axis,
                                    double at, double sign) {
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = sign * (p[axis] - at), b = sign * (q[axis] - at);
    if (a >= 0) out.push_back(p);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) out.emplace_back(p + (q - p) * (a / (a - b)));
  }
  return out;
}

Polygon Shared(const Polygon& a, const Polygon& b) {
  Polygon out = a;
  for (std::size_t i = 0; i < b.size() && !out.empty(); ++i) {
    out = LeftOf(out, b[i], b[(i + 1) % b.size()]);
  }
  return out;
}

std::vector<Polygon> Subtract(std::vector<Polygon> pieces, std::span<const Polygon> holes) {
  for (const Polygon& hole : holes) {
    std::vector<Polygon> outside;
    for (const Polygon& piece : pieces) {
      if (Shared(piece, hole).empty()) {
        outside.push_back(piece);
        continue;
      }
      Polygon inside = piece;
      for (std::size_t i = 0; i < hole.size() && !inside.empty(); ++i) {
        const Vector2d &a = hole[i], &b = hole[(i + 1) % hole.size()];
        if (auto cut = LeftOf(inside, b, a); !cut.empty()) outside.push_back(std::move(cut));
        inside = LeftOf(inside, a, b);
      }
    }
    pieces = std::move(outside);
  }
  return pieces;
}

bool Contains(const Polygon& polygon, const Vector2d& p) {
  bool is_inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vector2d &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) is_inside = !is_inside;
  }
  return is_inside;
}

Polygon Hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y());
  });
  Polygon hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= first + 2 && Turn(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return Cleaned(hull);
}

}  // namespace crossnav::homes
