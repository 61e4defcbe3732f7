// SPDX-License-Identifier: MIT
// Choice of an outlook: a place that the best hypothesis can walk to, and from where the map
// predicts different views under the other hypotheses, for a short walk.
#pragma once

#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/localization/dense_map.h"
#include "crossnav/localization/hypothesis.h"
#include "crossnav/planner/ground_map.h"

namespace crossnav::localization {

struct Outlook {
  std::vector<geometry::VoxelKey> path_map;  ///< places to stand, from the foot; in the map
  double difference = 0;                     ///< share of the predicted rays that differ, 0 to 1
};

/// Path under `hypotheses[0]`; empty if no place within reach tells it from the next `others`
/// hypotheses. `p_foot_odom`: the robot's foot.
Outlook FindOutlook(const DenseMap& map, const planner::GroundMap& ground,
                    const std::vector<Hypothesis>& hypotheses, int others,
                    const Vector3d& p_foot_odom, double camera_height_m);

}  // namespace crossnav::localization
