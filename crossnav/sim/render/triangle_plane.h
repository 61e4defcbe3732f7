// SPDX-License-Identifier: MIT
// Where a ray meets a triangle's plane, for rays of Embree and of pictures alike: in double
// precision, since Embree divides by an estimate of the processor, which differs from maker to
// maker.
#pragma once

#include "crossnav/core/pose.h"

namespace crossnav::sim {

/// A plane as rays from one point meet it: at the ray parameter rise / (normal . direction), but
/// where the square of that product is less than `least` they only graze it. World frame, metres.
struct SeenPlane {
  Vector3d normal = Vector3d::Zero();  ///< not of unit length
  double rise = 0, least = 0;
};

/// Of the triangle with these corners, from `origin`.
inline SeenPlane SeePlane(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                          const Vector3d& origin) {
  constexpr double kGraze = 1e-6;  // chosen: sine of the angle, far below a pixel's
  const Vector3d normal = (b - a).cross(c - a);
  return {normal, normal.dot(a) - normal.dot(origin), kGraze * kGraze * normal.squaredNorm()};
}

}  // namespace crossnav::sim
