// SPDX-License-Identifier: MIT
// Hypothesis: a pose of the odometry's frame in the map's frame, with its evidence. Both frames
// have z up (gravity is known), so that a pose has four degrees of freedom.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/localization/localize_config.h"

namespace crossnav::localization {

/// Verdict of the map on one beam under a hypothesis.
enum class Verdict : std::uint8_t { kNothing, kAgrees, kContradicts };

struct Hypothesis {
  Pose T_map_odom = Pose::Identity();
  double score = 0;  ///< mean of the points' scores, 0 to 100
  double agreement =
      0;  ///< share of beams that agree with the map; beams without a verdict count half
  std::vector<Verdict> verdicts;  ///< of the scan's beams
};

/// Lead of `a` over `b`: beams that support only one of them.
struct Lead {
  int won = 0, lost = 0;

  double share(std::size_t beams) const {
    return beams > 0 ? static_cast<double>(won - lost) / static_cast<double>(beams) : 0;
  }
  /// Standard deviations by which `won` exceeds `lost`, for independent beams (they are not).
  double sigmas() const { return won > lost ? (won - lost) / std::sqrt(double(won + lost)) : 0; }
};
inline Lead LeadOf(const Hypothesis& a, const Hypothesis& b) {
  Lead lead;
  for (std::size_t i = 0; i < std::min(a.verdicts.size(), b.verdicts.size()); ++i) {
    const bool for_a = a.verdicts[i] == Verdict::kAgrees, for_b = b.verdicts[i] == Verdict::kAgrees;
    lead.won += for_a && !for_b ? 1 : 0;
    lead.lost += for_b && !for_a ? 1 : 0;
  }
  return lead;
}

/// The pose that puts `p_odom` at `p_map` with the odometry's axes turned by `yaw_rad`.
inline Pose PlaceAt(const Vector3d& p_map, double yaw_rad, const Vector3d& p_odom) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = p_map - T.linear() * p_odom;
  return T;
}

/// Frame of a foot: x ahead, z up. Odometry starts in it.
inline Pose FootFrameOf(const AgentPose& foot_world) {
  return PlaceAt(foot_world.p_world, foot_world.yaw_rad, Vector3d::Zero());
}

inline double YawOf(const Pose& T_map_odom) {
  return std::atan2(T_map_odom.linear()(1, 0), T_map_odom.linear()(0, 0));
}

/// Whether both poses put a foot at `p_odom` at about the same place and heading.
inline bool IsSame(const Pose& a, const Pose& b, const Vector3d& p_odom,
                   const LocalizeConfig& config) {
  if ((a * p_odom - b * p_odom).norm() >= config.distinct_m) return false;
  return std::abs(WrapAngle(YawOf(a) - YawOf(b))) < DegToRad(config.distinct_deg);
}

}  // namespace crossnav::localization
