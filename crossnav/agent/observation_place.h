// SPDX-License-Identifier: MIT
// Where to stand to look at a place of the memory, coming from somewhere (paper, "History POIs"):
// for the agent on its way, and for those who only ask. World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/config.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/planner/astar.h"

namespace crossnav::agent {

constexpr int kBlindRing_vox = 4;  // chosen: what lies under a camera one pitch step down

/// Places to stand with a view, and the way to the cheapest that can be reached.
struct ViewPath {
  std::vector<geometry::VoxelKey> standing;
  planner::Plan plan;
  planner::GraphRules rules;
};

/// Within the approach range of `voxels` if one can be reached there, else within twice that.
std::optional<ViewPath> PathToView(const geometry::VoxelMap& map, const geometry::VoxelKey& start,
                                   const std::vector<geometry::VoxelKey>& voxels,
                                   const planner::GraphRules& rules, const Config& config);

struct ObservationPlace {
  Vector3d p_foot_world = Vector3d::Zero();
  double yaw_rad = 0;  ///< from there to the place's centre
  double path_m = 0;   ///< length of the way
};

/// Empty if no place to stand with a view of `cluster` is reachable from `p_from_world` (a foot
/// point), or if nothing known to be walkable is near the latter.
std::optional<ObservationPlace> FindObservationPlace(const geometry::VoxelMap& map,
                                                     const memory::MemoryCluster& cluster,
                                                     const Vector3d& p_from_world,
                                                     const Config& config);

}  // namespace crossnav::agent
