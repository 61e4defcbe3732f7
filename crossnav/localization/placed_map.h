// SPDX-License-Identifier: MIT
// Saved map for localisation, and the robot's body. Map frame.
#pragma once

#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/result.h"
#include "crossnav/localization/dense_map.h"
#include "crossnav/localization/localize_config.h"
#include "crossnav/planner/ground_map.h"

namespace crossnav::localization {

/// A saved map, prepared for localisation. Read-only after construction.
struct PlacedMap {
  DenseMap dense;
  planner::GroundMap ground;
  std::vector<geometry::VoxelKey> places;  ///< candidates for the foot
};

/// Errors: a map without ground, or too large (dense_map.h).
Result<PlacedMap> PlaceMap(const geometry::VoxelMap& map, const LocalizeConfig& config = {});

/// Camera and motion of the robot.
struct Body {
  double camera_height_m = 0.88;
  ActionConfig action;
  geometry::MapConfig map;
};

}  // namespace crossnav::localization
