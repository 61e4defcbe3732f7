// SPDX-License-Identifier: MIT
// Objects of one goal in the frames of a recording: detections merged over frames by the agent's
// rules.
#pragma once

#include <string>
#include <vector>

#include "crossnav/agent/config.h"
#include "crossnav/policy/live_poi.h"

namespace crossnav::app {

class GoalSightings {
 public:
  /// `config` and `suite` must outlive it.
  GoalSightings(const agent::Config& config, const perception::PerceptionSuite& suite,
                std::string goal)
      : config_(config), suite_(suite), goal_(std::move(goal)) {}

  Result<void> Look(const Observation& obs);

  /// Whether the detector has a class for the goal.
  bool is_known() const { return is_known_; }
  /// Stable places, most confident first.
  std::vector<const policy::LivePoi*> Places() const { return pois_.Stable(config_.policy.object); }
  /// A JSON array: centre [m], frames and best confidence of each.
  std::string PlacesJson() const;
  /// A line for each place.
  std::string PlacesText() const;

 private:
  const agent::Config& config_;
  const perception::PerceptionSuite& suite_;
  std::string goal_;
  bool is_known_ = true;
  int frames_ = 0;
  policy::LivePois pois_;
};

}  // namespace crossnav::app
