// SPDX-License-Identifier: MIT
// Light of a house, baked into vertex colours: daylight through windows, lamps, what bounces about
// in a room, and the dimness of corners. Not physics: a picture should read as a room, and none be
// so dark that one sees nothing. Deterministic; world frame, metres.
#pragma once

#include <set>
#include <vector>

#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// A lamp (both vectors zero) or a window (half its width and half its height).
struct Light {
  Vector3d p_world = Vector3d::Zero();
  Vector3d half_width = Vector3d::Zero(), half_height = Vector3d::Zero();
  Vector3d inward = Vector3d::Zero();  ///< of a window
  Vector3d colour = Vector3d::Ones();
  double power = 0;  ///< of a lamp [m2]; of a window, per m2 of it
  int room = -1;

  bool IsWindow() const { return inward.squaredNorm() > 0; }
};

struct HouseLights {
  std::vector<Light> lights;
  std::vector<Vector3d> bounced;  ///< per room: light from everywhere
};

/// Windows of outer walls, and lamps where they stand or hang.
HouseLights LightsOf(const HousePlan& plan);

/// Sets scene.mesh.vertex_colours; triangles should be small (Subdivide). Materials in `glowing`
/// and lamps stay as bright as they are.
void BakeLight(sim::Scene& scene, const HousePlan& plan, const HouseLights& lights,
               const std::set<int>& glowing);

}  // namespace crossnav::world
