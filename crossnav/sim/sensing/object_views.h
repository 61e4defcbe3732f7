// SPDX-License-Identifier: MIT
// Places to stand with a good view of an object, and the object's image from there. For pictures
// that judge detectors and renderings; the benchmark's own viewpoints are in scene_info.h.
#pragma once

#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/perception/perception.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

struct ViewRules {
  SensorConfig sensor;
  double near_m = 1.0, far_m = 3.0;    ///< horizontally, to the middle of the object's box
  double min_visible = 0.7;            // chosen: most of it, but a table may hide a leg
  double min_box_fraction = 1.0 / 64;  ///< of the picture, as the agent asks of a detection
  int per_object = 4;
};

struct ObjectView {
  AgentPose pose;  ///< on the navmesh, turned to the object, camera level
  int instance = 0;
  double distance_m = 0;        ///< horizontally, to the middle of the object's box
  perception::PixelBox box;     ///< of its visible pixels
  int visible_px = 0;           ///< of the object in the picture
  double visible_fraction = 0;  ///< of the silhouette it would have alone in an endless picture
};

/// Up to `rules.per_object` good views, spread evenly over the available directions (every n-th of
/// all on a 0.2 m grid, ordered by direction). Empty without a good view. Deterministic. Costs some
/// milliseconds per grid point.
std::vector<ObjectView> GoodViews(const Scene& scene, const NavMesh& navmesh,
                                  const RayCaster& caster, const SceneInstance& instance,
                                  const ViewRules& rules);

struct VisibleObject {
  int instance = 0;
  perception::PixelBox box;
  int visible_px = 0;
};

/// All instances with at least `min_px` pixels, by id.
std::vector<VisibleObject> VisibleObjects(const InstanceImage& image, int min_px);

}  // namespace crossnav::sim
