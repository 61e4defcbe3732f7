// SPDX-License-Identifier: MIT
#include "crossnav/agent/observation_place.h"

#include <cmath>
#include <utility>

#include "crossnav/planner/astar.h"
#include "crossnav/policy/approach.h"

namespace crossnav::agent {

std::optional<ViewPath> PathToView(const geometry::VoxelMap& map, const geometry::VoxelKey& start,
                                   const std::vector<geometry::VoxelKey>& voxels,
                                   const planner::GraphRules& rules, const Config& config) {
  const auto& approach = config.policy.approach;
  for (const double range_m : {approach.range_m, 2 * approach.range_m}) {
    ViewPath view;
    view.standing =
        policy::Viewpoints(map, voxels, range_m, approach, config.sensor.camera_height_m);
    if (view.standing.empty()) continue;
    view.rules = rules;
    view.plan = planner::FindPath(map, start, view.standing, view.rules, config.planner);
    if (!view.plan.found()) {
      view.rules.allow_inflated = true;
      view.plan = planner::FindPath(map, start, view.standing, view.rules, config.planner);
    }
    if (view.plan.found()) return view;
  }
  return std::nullopt;
}

std::optional<ObservationPlace> FindObservationPlace(const geometry::VoxelMap& map,
                                                     const memory::MemoryCluster& cluster,
                                                     const Vector3d& p_from_world,
                                                     const Config& config) {
  const auto start = planner::StartVoxel(map, p_from_world);
  if (!start) return std::nullopt;
  planner::GraphRules rules;
  rules.start_reach_vox = kBlindRing_vox;
  const auto view = PathToView(map, *start, cluster.voxels, rules, config);
  if (!view) return std::nullopt;
  const double voxel_m = map.config().voxel_m;
  ObservationPlace place;
  place.p_foot_world = CenterOf(view->plan.path.back(), voxel_m);
  // The voxel is free air; the support of the foot lies below it.
  if (const auto support = planner::SupportZ(map, view->plan.path.back()))
    place.p_foot_world.z() = (*support + 0.5) * voxel_m;
  const Vector3d to_center = cluster.p_center_world - place.p_foot_world;
  place.yaw_rad = std::atan2(to_center.y(), to_center.x());
  for (std::size_t i = 1; i < view->plan.path.size(); ++i)
    place.path_m += voxel_m * geometry::VoxelDistance(view->plan.path[i - 1], view->plan.path[i]);
  return place;
}

}  // namespace crossnav::agent
