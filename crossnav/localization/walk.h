// SPDX-License-Identifier: MIT
// The walk of a robot that does not know where it is: towards an outlook that the best hypothesis
// can walk to, and no step onto what was seen to be no way.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/pose.h"
#include "crossnav/localization/belief.h"

namespace crossnav::localization {

/// Whether the scan's points let a body take a step ahead: nothing between knee and head in its
/// way, and ground at about its feet where any was seen.
bool IsWayClear(const std::vector<Vector3f>& points_odom, const AgentPose& foot_odom,
                const Body& body);

class Walk {
 public:
  /// The next action; nothing on arrival, and where there is nowhere to walk to.
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
