// SPDX-License-Identifier: MIT
// Where to walk so that hypotheses come apart: of the places that the best hypothesis can walk to,
// one from where the map predicts different views under the others, for as few steps as possible.
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

/// Path under `hypotheses[0]`; empty where no place within `reach_m` of walking tells it from the
/// next `others` of them. `p_foot_odom`: where the robot stands.
Outlook FindOutlook(const DenseMap& map, const planner::GroundMap& ground,
                    const std::vector<Hypothesis>& hypotheses, int others,
                    const Vector3d& p_foot_odom, double camera_height_m);

}  // namespace crossnav::localization
