// SPDX-License-Identifier: MIT
// Storeys of a map: ground in large connected pieces of one height, grouped by height. World frame.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/scenegraph/plan_grid.h"

namespace crossnav::scenegraph {

/// Ground of a column without a storey.
inline constexpr int kNoGround = -1'000'000;

struct Storey {
  double height_m = 0;  ///< of its largest level
  double area_m2 = 0;   ///< of its levels
  /// Most common height of the ceiling above the ground; empty where too little was seen.
  std::optional<double> ceiling_m;
  /// Lowest voxel above the ground of each column: of the nearest level, up to two metres away.
  PlanGrid<int> ground_z;
};

/// By height. Levels less than 1.5 m above the lowest of a storey belong to it.
std::vector<Storey> FindStoreys(const geometry::VoxelMap& map);

}  // namespace crossnav::scenegraph
