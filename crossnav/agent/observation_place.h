// SPDX-License-Identifier: MIT
// Observation places: where to stand to see a place of the memory, for a given start (paper,
// "History POIs"). Serves the agent and map queries. World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/config.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/planner/astar.h"

namespace crossnav::agent {

constexpr int kBlindRing_vox = 4;  // chosen: blind ground under a camera one pitch step down

/// Places to stand with a view, and the path to the cheapest reachable place.
struct ViewPath {
  std::vector<geometry::VoxelKey> standing;
  planner::Plan plan;
  planner::GraphRules rules;
};

/// Path to a view within the approach range of `voxels`, else within twice that range.
std::optional<ViewPath> PathToView(const geometry::VoxelMap& map, const geometry::VoxelKey& start,
                                   const std::vector<geometry::VoxelKey>& voxels,
                                   const planner::GraphRules& rules, const Config& config);

struct ObservationPlace {
  Vector3d p_foot_world = Vector3d::Zero();
  double yaw_rad = 0;  ///< from there to the place's centre
  double path_m = 0;   ///< length of the path
};

/// Empty if no place to stand with a view of `cluster` is reachable from `p_from_world` (a foot
/// point), or if nothing known to be walkable is near the latter.
std::optional<ObservationPlace> FindObservationPlace(const geometry::VoxelMap& map,
                                                     const memory::MemoryCluster& cluster,
                                                     const Vector3d& p_from_world,
                                                     const Config& config);

}  // namespace crossnav::agent
