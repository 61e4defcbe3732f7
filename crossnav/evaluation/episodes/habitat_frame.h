// SPDX-License-Identifier: MIT
// Episode files keep Habitat's frame (y up, -z forward), so that Habitat's tools read them too.
// world = (-z_h, -x_h, y_h); a rotation by theta about y_h is a yaw by theta.
#pragma once

#include <array>
#include <cmath>

#include "crossnav/core/pose.h"

namespace crossnav::evaluation {

inline Vector3d WorldFromHabitat(const Vector3d& p) {
  return {-p.z(), -p.x(), p.y()};
}
inline Vector3d HabitatFromWorld(const Vector3d& p) {
  return {-p.y(), p.z(), -p.x()};
}

/// Yaw of a rotation quaternion [x, y, z, w]: of the rotated camera forward axis (0, 0, -1).
inline double YawFromHabitat(const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  const double forward_x = -2 * (x * z + w * y);
  const double forward_z = -(1 - 2 * (x * x + y * y));
  return std::atan2(-forward_x, -forward_z);
}

inline std::array<double, 4> HabitatFromYaw(double yaw_rad) {
  return {0, std::sin(yaw_rad / 2), 0, std::cos(yaw_rad / 2)};
}

}  // namespace crossnav::evaluation
