// SPDX-License-Identifier: MIT
// Viewpoints of a goal's instances as a file beside the navmesh's: they cost most of the time that
// a scene takes to load. World frame, metres.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::evaluation {

/// What viewpoints follow from.
struct ViewedScene {
  const sim::Scene& scene;
  const sim::NavMesh& navmesh;
  const sim::RayCaster& caster;
  const SensorConfig& sensor;
};

/// Viewpoints of each of the instances; read from `<hash>.crossnav.viewpoints`
/// (sim/scene/scene_cache.h) where that is of the same mesh, navmesh, camera and instances, found
/// and written otherwise.
std::vector<std::vector<Vector3d>> ViewpointsOf(
    const ViewedScene& viewed, const std::vector<const sim::SceneInstance*>& instances);

}  // namespace crossnav::evaluation
