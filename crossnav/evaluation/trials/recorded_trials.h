// SPDX-License-Identifier: MIT
// Localisation on frames of a real sensor: of each three frames the second makes the map, the two
// others are for robots that wake up. A recording cannot be steered, so that the robot sees what
// its bearer looked at: views are added in the order of the recording until the pose is known.
#pragma once

#include <cstdint>
#include <vector>

#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/evaluation/trials/localize_trials.h"

namespace crossnav::evaluation {

struct RecordedTrials {
  int frames = 0, mapped = 0;
  double camera_height_m = 0;     ///< median of the mapped frames, over the map's lowest storey
  std::vector<LostTrial> trials;  ///< one for each other frame; `actions` is the number of views
};

/// `most_views` bounds a robot's views. The odometry's frame is turned and moved at random, but for
/// gravity. Errors: fewer than three frames, or a map without ground.
Result<RecordedTrials> TryRecorded(const std::vector<Observation>& frames, const RunConfig& config,
                                   int most_views, std::uint64_t seed);

}  // namespace crossnav::evaluation
