// SPDX-License-Identifier: MIT
// Baked light of a house, as vertex colours: daylight through windows, lamps, indirect light, and
// dim corners. An approximation: pictures should show a recognisable room and never be too dark.
// Deterministic; world frame, metres.
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
  std::vector<Vector3d> bounced;  ///< per room: indirect light
};

/// Windows of outer walls, and lamps.
HouseLights LightsOf(const HousePlan& plan);

/// Sets scene.mesh.vertex_colours; triangles should be small (Subdivide). Materials in `glowing`
/// and lamps keep their brightness.
void BakeLight(sim::Scene& scene, const HousePlan& plan, const HouseLights& lights,
               const std::set<int>& glowing);

}  // namespace crossnav::world
