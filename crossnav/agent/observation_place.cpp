// SPDX-License-Identifier: MIT
#include "crossnav/agent/observation_place.h"

#include <cmath>
#include <utility>

#include "crossnav/planner/astar.h"
#include "crossnav/policy/approach.h"

namespace crossnav::agent {

std::optional<ViewWay> WayToView(const geometry::VoxelMap& map, const geometry::VoxelKey& start,
                                 const std::vector<geometry::VoxelKey>& voxels,
                                 const planner::GraphRules& rules, const Config& config) {
  const auto& approach = config.policy.approach;
  for (const double range_m : {approach.range_m, 2 * approach.range_m}) {
    ViewWay way;
    way.standing =
        policy::Viewpoints(map, voxels, range_m, approach, config.sensor.camera_height_m);
    if (way.standing.empty()) continue;
    way.rules = rules;
    way.plan = planner::FindPath(map, start, way.standing, way.rules, config.planner);
    if (!way.plan.found()) {
      way.rules.allow_inflated = true;
      way.plan = planner::FindPath(map, start, way.standing, way.rules, config.planner);
    }
    if (way.plan.found()) return way;
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
  const auto way = WayToView(map, *start, cluster.voxels, rules, config);
  if (!way) return std::nullopt;
  const double voxel_m = map.config().voxel_m;
  ObservationPlace place;
  place.p_foot_world = CenterOf(way->plan.path.back(), voxel_m);
  // The voxel is one of the air above what carries the foot.
  if (const auto support = planner::SupportZ(map, way->plan.path.back()))
    place.p_foot_world.z() = (*support + 0.5) * voxel_m;
  const Vector3d to_center = cluster.p_center_world - place.p_foot_world;
  place.yaw_rad = std::atan2(to_center.y(), to_center.x());
  for (std::size_t i = 1; i < way->plan.path.size(); ++i)
    place.path_m += voxel_m * geometry::VoxelDistance(way->plan.path[i - 1], way->plan.path[i]);
  return place;
}

}  // namespace crossnav::agent
