// SPDX-License-Identifier: MIT
// A straight flight between two floors at any heading: as triangles for the navmesh and the camera,
// and as the ground that a camera which saw all of it would leave. World frame, metres.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "crossnav/core/cells.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::test {

struct StairCase {
  double riser_m = 0.2, tread_m = 0.25;
  int risers = 8;
  double width_m = 1.0;
  double heading_rad = 0;          ///< of the ascent
  Vector3d p_foot_world{0, 0, 0};  ///< middle of the first riser's lower edge
  double floor_m = 1.6;            ///< length of the floors before and after
  bool has_walls = true;           ///< on both sides of the flight
  double top_m() const { return risers * riser_m; }
  double end_m() const { return (risers - 1) * tread_m; }

  /// From along (up the flight), left and height to the world.
  Vector3d At(double along_m, double left_m, double z_m) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    return p_foot_world + Vector3d(c * along_m - s * left_m, s * along_m + c * left_m, z_m);
  }
  Vector3d Foot() const { return At(-0.6, 0, 0); }
  Vector3d Top() const { return At(end_m() + 0.6, 0, top_m()); }
};

/// Four corners in order; `is_ground` = a floor or tread.
struct Facet {
  std::array<Vector3d, 4> p_world;
  bool is_ground = false;
};

inline std::vector<Facet> FacetsOf(const StairCase& s) {
  std::vector<Facet> facets;
  const double half_m = 0.5 * s.width_m;
  const auto ground = [&](double from_m, double to_m, double z_m) {
    facets.push_back({{s.At(from_m, -half_m, z_m), s.At(to_m, -half_m, z_m),
                       s.At(to_m, half_m, z_m), s.At(from_m, half_m, z_m)},
                      true});
  };
  const auto upright = [&](const Vector3d& a, const Vector3d& b, double z_m) {
    const Vector3d up(0, 0, z_m);
    facets.push_back({{a, b, b + up, a + up}, false});
  };
  ground(-s.floor_m, 0, 0);
  for (int i = 0; i < s.risers; ++i) {
    const double u = i * s.tread_m, z = i * s.riser_m;
    upright(s.At(u, -half_m, z), s.At(u, half_m, z), s.riser_m);
    const bool is_last = i == s.risers - 1;
    ground(u, is_last ? u + s.floor_m : u + s.tread_m, z + s.riser_m);
  }
  if (s.has_walls)
    for (const double side_m : {-half_m, half_m})
      upright(s.At(-s.floor_m, side_m, 0), s.At(s.end_m() + s.floor_m, side_m, 0), s.top_m() + 2.2);
  return facets;
}

inline sim::Scene SceneOf(const std::vector<Facet>& facets) {
  sim::Scene scene;
  scene.id = "stair_case";
  scene.instances.push_back({1, "floor", "", 0, {}});
  for (const Facet& facet : facets) {
    sim::TriangleMesh& mesh = scene.mesh;
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vector3d& p : facet.p_world) mesh.vertices.push_back(p.cast<float>());
    mesh.triangles.push_back({base, base + 1, base + 2});
    mesh.triangles.push_back({base, base + 2, base + 3});
    mesh.triangle_material.insert(mesh.triangle_material.end(), 2, 0);
    mesh.triangle_instance.insert(mesh.triangle_instance.end(), 2, 1);
  }
  UpdateDerived(scene);
  return scene;
}

/// Every surface in its voxel, seen air over all ground up to 2 m.
inline planner::GroundMap FullGround(const std::vector<Facet>& facets,
                                     const geometry::MapConfig& config) {
  constexpr double kAir_m = 2.0;
  std::vector<geometry::VoxelKey> surface, air;
  for (const Facet& facet : facets) {
    const Vector3d a = facet.p_world[1] - facet.p_world[0], b = facet.p_world[3] - facet.p_world[0];
    const int na = CellsCeil(a.norm(), 0.3 * config.voxel_m),
              nb = CellsCeil(b.norm(), 0.3 * config.voxel_m);
    for (int i = 0; i <= na; ++i)
      for (int k = 0; k <= nb; ++k) {
        const Vector3d p = facet.p_world[0] + a * i / na + b * k / nb - Vector3d(0, 0, 1e-4);
        surface.push_back(geometry::KeyOf(p, config.voxel_m));
        if (facet.is_ground) air.push_back(surface.back());
      }
  }
  const auto make_unique = [](std::vector<geometry::VoxelKey>& keys) {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  };
  make_unique(surface);
  make_unique(air);
  std::vector<geometry::StateChange> changes;
  for (const auto& key : air)
    for (int z = 1; z <= CellsFloor(kAir_m, config.voxel_m); ++z)
      changes.push_back({{key.x, key.y, key.z + z}, {geometry::VoxelState::kTraversable, false}});
  for (const auto& key : surface)
    changes.push_back({key, {geometry::VoxelState::kOccupied, false}});
  planner::GroundMap ground(config);
  ground.Update(changes);
  return ground;
}

}  // namespace crossnav::test
