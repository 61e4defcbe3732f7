// SPDX-License-Identifier: MIT
#include "crossnav/world/models/face_triangles.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace crossnav::world {
namespace {

using Vector2d = Eigen::Vector2d;

constexpr std::size_t kMaxConcave = 1000;  // chosen: ear cutting costs n^2 and more

double Turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

/// The corners in the face's own plane, counter-clockwise.
std::vector<Vector2d> Flattened(std::span<const Vector3f> corners) {
  Vector3d normal = Vector3d::Zero();  // Newell: twice the area, also of concave faces
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d a = (corners[i] - corners[0]).cast<double>();
    const Vector3d b = (corners[(i + 1) % corners.size()] - corners[0]).cast<double>();
    normal += a.cross(b);
  }
  if (normal.norm() <= 0) return {};
  normal.normalize();
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Vector2d> flat;
  for (const Vector3f& corner : corners) {
    const Vector3d p = (corner - corners[0]).cast<double>();
    flat.emplace_back(p.dot(u), p.dot(v));
  }
  return flat;
}

double ExtentOf(const std::vector<Vector2d>& flat) {
  double extent = 0;
  for (const Vector2d& p : flat) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  return extent;
}

bool IsConvex(const std::vector<Vector2d>& flat, double tolerance) {
  const std::size_t n = flat.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (Turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < -tolerance) return false;
  }
  return true;
}

/// An ear is a convex corner with no other corner inside; `margin` < 0 tolerates corners on its
/// edge.
bool IsEar(const std::vector<Vector2d>& flat, const std::vector<std::size_t>& rest, std::size_t i,
           double margin) {
  const std::size_t n = rest.size();
  const Vector2d &a = flat[rest[(i + n - 1) % n]], &b = flat[rest[i]], &c = flat[rest[(i + 1) % n]];
  if (Turn(a, b, c) <= std::abs(margin)) return false;
  for (const std::size_t k : rest) {
    const Vector2d& p = flat[k];
    if (p == a || p == b || p == c) continue;
    if (Turn(a, b, p) >= -margin && Turn(b, c, p) >= -margin && Turn(c, a, p) >= -margin) {
      return false;
    }
  }
  return true;
}

/// Position in `rest` of a corner that is an ear; its size if none is.
std::size_t FindEar(const std::vector<Vector2d>& flat, const std::vector<std::size_t>& rest,
                    double margin) {
  std::size_t i = 0;
  while (i < rest.size() && !IsEar(flat, rest, i, margin)) ++i;
  return i;
}

/// Position in `rest` of the corner with the least area: used if no ear exists, as in a face that
/// crosses itself.
std::size_t FlattestCorner(const std::vector<Vector2d>& flat,
                           const std::vector<std::size_t>& rest) {
  const std::size_t n = rest.size();
  const auto turn_at = [&](std::size_t i) {
    return std::abs(Turn(flat[rest[(i + n - 1) % n]], flat[rest[i]], flat[rest[(i + 1) % n]]));
  };
  std::size_t flattest = 0;
  for (std::size_t i = 1; i < n; ++i)
    if (turn_at(i) < turn_at(flattest)) flattest = i;
  return flattest;
}

}  // namespace

std::vector<std::array<std::size_t, 3>> FaceTriangles(std::span<const Vector3f> corners) {
  std::vector<std::array<std::size_t, 3>> triangles;
  const std::size_t n = corners.size();
  std::vector<Vector2d> flat;
  if (n > 3 && n <= kMaxConcave) flat = Flattened(corners);
  const double extent = ExtentOf(flat), tolerance = 1e-6 * extent * extent;
  if (flat.empty() || IsConvex(flat, tolerance)) {
    for (std::size_t i = 1; i + 1 < n; ++i) triangles.push_back({0, i, i + 1});
    return triangles;
  }
  std::vector<std::size_t> rest(n);
  for (std::size_t i = 0; i < n; ++i) rest[i] = i;
  while (rest.size() >= 3) {
    const std::size_t m = rest.size();
    std::size_t ear = FindEar(flat, rest, tolerance * 1e-3);
    if (ear == m) ear = FindEar(flat, rest, -tolerance * 1e-3);
    if (ear < m) {
      triangles.push_back({rest[(ear + m - 1) % m], rest[ear], rest[(ear + 1) % m]});
    } else {
      ear = FlattestCorner(flat, rest);
    }
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

}  // namespace crossnav::world
