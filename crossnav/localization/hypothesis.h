// SPDX-License-Identifier: MIT
// A pose of the odometry's frame in the map's frame, with what speaks for it. Both frames have z up
// (gravity is known), so that it has four degrees of freedom.
#pragma once

#include <cmath>

#include "crossnav/core/pose.h"
#include "crossnav/localization/localize_config.h"

namespace crossnav::localization {

struct Hypothesis {
  Pose T_map_odom = Pose::Identity();
  double score = 0;      ///< mean of the points' scores, 0 to 100
  double agreement = 0;  ///< share of the informative beams that agree with the map, 0 to 1
  int beams = 0;         ///< informative ones
};

/// The pose that puts `p_odom` at `p_map` with the odometry's axes turned by `yaw_rad`.
inline Pose PlaceAt(const Vector3d& p_map, double yaw_rad, const Vector3d& p_odom) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = p_map - T.linear() * p_odom;
  return T;
}

inline double YawOf(const Pose& T_map_odom) {
  return std::atan2(T_map_odom.linear()(1, 0), T_map_odom.linear()(0, 0));
}

/// True if both say about the same of a foot at `p_odom`.
inline bool IsSame(const Pose& a, const Pose& b, const Vector3d& p_odom,
                   const LocalizeConfig& config) {
  if ((a * p_odom - b * p_odom).norm() >= config.distinct_m) return false;
  return std::abs(WrapAngle(YawOf(a) - YawOf(b))) < DegToRad(config.distinct_deg);
}

}  // namespace crossnav::localization
