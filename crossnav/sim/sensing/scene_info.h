// SPDX-License-Identifier: MIT
// Report of `crossnav scene info`, and the viewpoints of instances, shared by benchmark and report.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// X(g): foot points on the navmesh (0.1 m grid, within 1.0 m horizontally of the instance's box)
/// from which at least 5 % of the instance's coverage is visible with the camera at its height,
/// turned to the instance, at pitch -30, 0 or +30 degrees. Reading taken: coverage is the
/// silhouette that the instance would have in those three images if nothing else were there, in
/// rays of even angular spacing; visible is the share of these rays whose first hit is the
/// instance. A point over (or under) the box counts where the instance is in view. Ordered by x,
/// then y, then z. Deterministic. Costs about 0.1 ms per grid point.
std::vector<Vector3d> Viewpoints(const Scene& scene, const NavMesh& navmesh,
                                 const RayCaster& caster, const SceneInstance& instance,
                                 const SensorConfig& sensor);

/// Floor with most of `viewpoints`, -1 without viewpoints (the instance cannot be seen).
int FloorOfViewpoints(const NavMesh& navmesh, const std::vector<Vector3d>& viewpoints);

struct InstanceInfo {
  int id = 0;
  std::string name;
  int floor = -1;  ///< of its viewpoints; -1 where it has none
  Box3 box;
  std::vector<Vector3d> viewpoints;
};

struct SceneInfo {
  std::string scene;
  NavMeshSettings navmesh_settings;
  std::uint64_t navmesh_hash = 0;
  double navmesh_area_m2 = 0;
  std::vector<Floor> floors;
  std::vector<FloorConnection> connections;
  std::map<std::string, std::vector<InstanceInfo>> instances;  ///< per category, by id
};

/// All of it. Viewpoints make up most of the cost: some milliseconds per instance.
SceneInfo DescribeScene(const Scene& scene, const NavMesh& navmesh, const RayCaster& caster,
                        const SensorConfig& sensor);

}  // namespace crossnav::sim
