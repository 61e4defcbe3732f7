// SPDX-License-Identifier: MIT
// Start in a saved map without a pose: localisation, then the agent's frame. If the pose is found,
// this is the map's frame, so that the agent can use the saved memory. Otherwise it is the
// odometry's frame, and the agent starts without a memory.
#pragma once

#include <memory>

#include "crossnav/localization/localizer.h"

namespace crossnav::localization {

class Awakening {
 public:
  /// Errors as PlaceMap. `map` is not kept.
  static Result<Awakening> In(const geometry::VoxelMap& map, const Body& body,
                              const LocalizeConfig& config = {});

  /// While localising: takes an observation in the odometry's frame.
  const LocalizeStep& Step(const Observation& obs);

  const LocalizeStep& last() const { return last_; }
  bool IsOver() const { return last_.status != Status::kLocalising; }
  int actions() const { return localizer_->actions(); }
  /// From the odometry's frame to the agent's frame.
  Pose T_agent_odom() const {
    return last_.status == Status::kKnown ? last_.T_map_odom : Pose::Identity();
  }

 private:
  Awakening() = default;
  std::unique_ptr<const PlacedMap> map_;
  std::unique_ptr<Localizer> localizer_;
  LocalizeStep last_;
};

}  // namespace crossnav::localization
