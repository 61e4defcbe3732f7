// SPDX-License-Identifier: MIT
// Cache of viewpoints as a file beside the navmesh's: they take most of a scene's loading time.
// World frame, metres.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::evaluation {

/// Inputs of the viewpoints.
struct ViewedScene {
  const sim::Scene& scene;
  const sim::NavMesh& navmesh;
  const sim::RayCaster& caster;
  const SensorConfig& sensor;
};

/// Viewpoints of each instance: read from `<hash>.crossnav.viewpoints` (sim/scene/scene_cache.h) if
/// that is of the same mesh, navmesh, camera and instances, else computed and written.
std::vector<std::vector<Vector3d>> ViewpointsOf(
    const ViewedScene& viewed, const std::vector<const sim::SceneInstance*>& instances);

}  // namespace crossnav::evaluation
