// SPDX-License-Identifier: MIT
// View of a house, generated or imported, from its triangles: rooms with walkable ground, objects
// with their supports, and narrow places between rooms. World frame, metres.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

inline constexpr double kGroundGrid_m = 0.15;  // chosen: four points across a narrow door

struct RoomView {
  int region = 0;                ///< of the semantic text
  int floor = 0;                 ///< of the navmesh
  std::vector<Vector3d> ground;  ///< points on a grid that can be reached from the start
  bool is_bath = false, is_kitchen = false;

  double AreaM2() const {
    return static_cast<double>(ground.size()) * kGroundGrid_m * kGroundGrid_m;
  }
};

struct ObjectView {
  int room = -1;    ///< index of RoomView; -1 = none
  int support = 0;  ///< instance below it, 0 = nothing
  bool is_on_ground = false;
  bool is_carrier = false;  ///< carries another object
  int landmark = 0;         ///< for objects on the ground: large piece beside, 0 = none
};

struct HouseView {
  std::unique_ptr<sim::NavMesh> navmesh;
  Vector3d start_world = Vector3d::Zero();  ///< a place in the largest part
  std::vector<RoomView> rooms;              ///< by floor and region
  std::map<int, ObjectView> objects;        ///< by instance
};

/// Error: no navmesh, no instances, no ground with a name.
Result<HouseView> ViewHouse(const sim::Scene& scene, const sim::NavMeshSettings& settings);

/// Instance and height of the first surface under `p_world` within `max_m`, without instance `but`.
std::optional<sim::RayHit> SurfaceBelow(const sim::RayCaster& caster, const Vector3d& p_world,
                                        int but, double max_m);

/// Large piece on the ground nearest to `box` within 0.7 m, 0 = none; ignores `but`.
int LandmarkBeside(const sim::Scene& scene, const Box3& box, int but);

/// Horizontal gap between two boxes, 0 where they overlap from above [m].
double GapOf(const Box3& a, const Box3& b);

}  // namespace crossnav::world
