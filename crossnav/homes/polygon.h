// SPDX-License-Identifier: MIT
// Polygons of a floor plan: triangulation of concave polygons, cutting, subtraction. Metres, seen
// from above; counter-clockwise unless said otherwise. Triangulate and Subtract give convex pieces
// that do not overlap.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace crossnav::homes {

using Vector2d = Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

/// > 0 for counter-clockwise.
double SignedArea(const Polygon& polygon);

/// Counter-clockwise, without repeated and collinear points; empty without an area.
Polygon Cleaned(const Polygon& polygon);

/// Triangles of a simple polygon of any orientation; a polygon that crosses itself gives an
/// incomplete set.
std::vector<Polygon> Triangulate(const Polygon& polygon);

/// The part of the convex `piece` on the left of the line from `a` to `b`.
Polygon LeftOf(const Polygon& piece, const Vector2d& a, const Vector2d& b);

/// Part of a polygon in space on one side of a plane across `axis`: above `at` for `sign` 1, below
/// it for -1.
std::vector<Eigen::Vector3d> SideOf(const std::vector<Eigen::Vector3d>& polygon, Eigen::Index axis,
                                    double at, double sign);

/// Intersection of two convex polygons; may be empty.
Polygon Shared(const Polygon& a, const Polygon& b);

/// `pieces` (convex) without `holes` (convex).
std::vector<Polygon> Subtract(std::vector<Polygon> pieces, std::span<const Polygon> holes);

bool Contains(const Polygon& polygon, const Vector2d& p);

/// Convex hull.
Polygon Hull(std::vector<Vector2d> points);

}  // namespace crossnav::homes
