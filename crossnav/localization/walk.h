// SPDX-License-Identifier: MIT
// Walk to an outlook without a known pose: the path is planned under the best hypothesis, and the
// scan vetoes steps into obstacles and drops.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/pose.h"
#include "crossnav/localization/belief.h"

namespace crossnav::localization {

/// Whether the scan permits a step ahead: no points between knee and head within the body's width,
/// and ground near foot height where ground was seen.
bool IsWayClear(const std::vector<Vector3f>& points_odom, const AgentPose& foot_odom,
                const Body& body);

class Walk {
 public:
  /// The next action; empty on arrival, and without a reachable outlook.
  std::optional<Action> Next(const PlacedMap& map, const Body& body, const LocalScan& scan,
                             const Belief& belief, const AgentPose& foot_odom);

  bool IsUnderWay() const { return p_target_odom_.has_value(); }
  bool HasArrived() const { return has_arrived_; }

 private:
  bool SetOut(const PlacedMap& map, const Body& body, const Belief& belief,
              const AgentPose& foot_odom);
  std::optional<Action> Follow(const PlacedMap& map, const Body& body, const LocalScan& scan,
                               const Pose& T_map_odom, const AgentPose& foot_odom);

  std::optional<Vector3d> p_target_odom_;
  std::deque<Action> motion_;
  std::optional<Vector3d> p_before_odom_;  // of the last step ahead
  bool has_arrived_ = false;
  int failures_ = 0;
};

}  // namespace crossnav::localization
