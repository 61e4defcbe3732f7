// SPDX-License-Identifier: MIT
// Ground truth about walking: Recast/Detour with the paper's settings. World frame, metres.
// The agent cannot link this room.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/core/result.h"
#include "crossnav/core/rng.h"
#include "crossnav/core/setting.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// tab:supp_configuration, rows "Navmesh". habitat-sim's own defaults differ.
struct NavMeshSettings {
  double agent_height_m = 1.50;
  double agent_radius_m = 0.10;
  double max_climb_m = 0.30;
  double max_slope_deg = 60;
  double cell_m = 0.03;
  double cell_height_m = 0.05;
  double min_island_m2 = 0.5;    // chosen: drops unreachable table tops
  std::string source = "build";  ///< build, or habitat: the .navmesh beside the scene, as it is
};

template <class V>
void Visit(V& visit, NavMeshSettings& c) {
  visit(CROSSNAV_SETTING(c, agent_height_m), 0.1, 3.0);
  visit(CROSSNAV_SETTING(c, agent_radius_m), 0.0, 2.0);
  visit(CROSSNAV_SETTING(c, max_climb_m), 0.0, 2.0);
  visit(CROSSNAV_SETTING(c, max_slope_deg), 0.0, 90.0);
  visit(CROSSNAV_SETTING(c, cell_m), 0.005, 1.0);
  visit(CROSSNAV_SETTING(c, cell_height_m), 0.005, 1.0);
  visit(CROSSNAV_SETTING(c, min_island_m2), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, source), {"build", "habitat"});
}

/// A storey: navmesh area of about one height (clusters of connected flat area), together with the
/// split levels less than 1.5 m above its lowest.
struct Floor {
  int id = 0;           ///< 0 = lowest
  double height_m = 0;  ///< of its largest level
  double area_m2 = 0;
  std::vector<double> levels_m;  ///< heights of its levels, ascending

  /// How far in height `z_m` is from the nearest of its levels [m].
  double GapTo(double z_m) const {
    double gap_m = std::abs(height_m - z_m);
    for (const double level_m : levels_m) gap_m = std::min(gap_m, std::abs(level_m - z_m));
    return gap_m;
  }
};

/// A walkable link between two floors.
struct FloorConnection {
  int lower = 0, upper = 0;
  double rise_m = 0;
};

/// Goals of ways on one navmesh, found on its polygons once for many searches.
struct WalkGoals {
  struct Place {
    std::uint64_t polygon = 0;
    Vector3d p_world;       ///< on the surface
    std::size_t index = 0;  ///< of the goal; goals off the navmesh have no place
  };
  std::vector<Place> places;
};

class NavMesh {
 private:
  struct Impl;

 public:
  ~NavMesh();
  NavMesh(NavMesh&&) noexcept;

  static Result<NavMesh> Build(const Scene& scene, const NavMeshSettings& settings);
  /// As Build, cached as `<hash>.crossnav.navmesh` (scene_cache.h), a hash of mesh and settings.
  static Result<NavMesh> BuildCached(const Scene& scene, const NavMeshSettings& settings);

  /// The navmesh of habitat-sim at `file`, as it was built there (agent, islands). `settings`: the
  /// settings of its build, as declared by the caller. Errors: missing, no navmesh, damaged,
  /// without ground.
  static Result<NavMesh> ReadHabitat(const std::filesystem::path& file,
                                     const NavMeshSettings& settings);
  /// As `settings.source` says: BuildCached, or ReadHabitat of the file beside the scene.
  static Result<NavMesh> Open(const Scene& scene, const NavMeshSettings& settings);

  const NavMeshSettings& settings() const;
  std::uint64_t Hash() const;
  double AreaM2() const;

  /// Nearest point of the navmesh within `xy_m` and `z_m`.
  std::optional<Vector3d> Snap(const Vector3d& p_world, double xy_m = 0.5, double z_m = 0.5) const;

  /// Heights of the walkable surfaces at (x, y) between the two limits, ascending [m].
  std::vector<double> HeightsAt(double x_m, double y_m, double z_low_m, double z_high_m) const;

  /// Walks straight from `start` towards `end` along the surface and stops at the first border (no
  /// sliding). Returns where it ended.
  Vector3d WalkStraight(const Vector3d& start_world, const Vector3d& end_world) const;

  /// Length of the shortest path, or nullopt where there is none (partial paths do not count).
  std::optional<double> Geodesic(const Vector3d& a_world, const Vector3d& b_world) const;
  /// Shortest over several goals; `nearest` gets the index of the goal.
  std::optional<double> Geodesic(const Vector3d& a_world, std::span<const Vector3d> goals_world,
                                 std::size_t* nearest = nullptr) const;
  /// The nearest places of the navmesh, as Geodesic would find them each time.
  WalkGoals FindGoals(std::span<const Vector3d> goals_world) const;
  std::optional<double> Geodesic(const Vector3d& a_world, const WalkGoals& goals,
                                 std::size_t* nearest = nullptr) const;
  /// Corner points of the shortest path, first = a, last = b; empty where there is none.
  std::vector<Vector3d> ShortestPath(const Vector3d& a_world, const Vector3d& b_world) const;

  std::optional<Vector3d> RandomPoint(Rng& rng) const;

  const std::vector<Floor>& Floors() const;                 ///< by height
  const std::vector<FloorConnection>& Connections() const;  ///< pairs of floors joined directly
  /// Floor with the level nearest to the point's height (for a point on a stair: the nearer end).
  int FloorOf(const Vector3d& p_world) const;

  /// Centres and areas of the walkable polygons, for pictures.
  struct Triangle {
    std::array<Vector3f, 3> p_world;
  };
  std::vector<Triangle> Triangles() const;

 private:
  NavMesh();
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::sim
