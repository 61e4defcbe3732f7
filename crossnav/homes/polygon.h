// SPDX-License-Identifier: MIT
// Polygons of a floor plan: triangles of concave ones, cutting, subtracting. Metres, seen from
// above; counter-clockwise unless said otherwise. What comes out of Triangulate and Subtract are
// convex pieces that do not overlap.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace crossnav::homes {

using Vector2d = Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

/// > 0 for counter-clockwise.
double SignedArea(const Polygon& polygon);

/// Counter-clockwise, without repeated points and without points on a straight line; empty where
/// nothing of an area is left.
Polygon Cleaned(const Polygon& polygon);

/// Triangles of a simple polygon (of any orientation); of one that crosses itself, some.
std::vector<Polygon> Triangulate(const Polygon& polygon);

/// The part of the convex `piece` on the left of the line from `a` to `b`.
Polygon LeftOf(const Polygon& piece, const Vector2d& a, const Vector2d& b);

/// The shared part of two convex polygons, empty where there is none.
Polygon Shared(const Polygon& a, const Polygon& b);

/// `pieces` (convex) without `holes` (convex).
std::vector<Polygon> Subtract(std::vector<Polygon> pieces, std::span<const Polygon> holes);

bool Contains(const Polygon& polygon, const Vector2d& p);

/// Convex hull.
Polygon Hull(std::vector<Vector2d> points);

}  // namespace crossnav::homes
