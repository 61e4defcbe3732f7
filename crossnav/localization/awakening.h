// SPDX-License-Identifier: MIT
// A robot that wakes up in a saved map without its pose: localisation first, then observations in
// the frame in which it goes on. Known: the map's frame, so that the saved memory can be its own.
// Unknown: the odometry's frame, with nothing known.
#pragma once

#include <memory>

#include "crossnav/localization/localizer.h"

namespace crossnav::localization {

class Awakening {
 public:
  /// Errors as PlaceMap. `map` is not kept.
  static Result<Awakening> In(const geometry::VoxelMap& map, const Body& body,
                              const LocalizeConfig& config = {});

  /// While localising: takes what was seen, in the odometry's frame.
  const LocalizeStep& Step(const Observation& obs);

  const LocalizeStep& last() const { return last_; }
  bool IsOver() const { return last_.status != Status::kLocalising; }
  int actions() const { return localizer_->actions(); }
  /// From the odometry's frame to that in which the robot goes on.
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
