// SPDX-License-Identifier: MIT
// Shortest paths on the navmesh's polygons, to the nearest of many goals. Detour's own search runs
// over edge midpoints and may return detours of several per cent; here the frontier is a set of
// intervals seen from the last turning point (as in Cui, Harabor and Grastien, "Compromise-free
// pathfinding on a navigation mesh", IJCAI 2017), so a path is shortest in plan view. Its length is
// then measured along the surface. Plan coordinates are the world's x and y, metres.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "crossnav/sim/navmesh/navmesh_detail.h"

namespace crossnav::sim {

using Vector2d = Eigen::Vector2d;

/// A point on the mesh: its polygon and where it is [world].
struct SurfacePoint {
  dtPolyRef ref = 0;
  Vector3d p_world = Vector3d::Zero();
};

/// One straight piece of a path inside one polygon.
struct PathPiece {
  dtPolyRef ref = 0;
  Vector2d from, to;
};

struct WalkPath {
  std::size_t goal = 0;  ///< index into the goals
  double plan_length_m = 0;
  std::vector<Vector2d> corners;  ///< start, turning points, goal
  std::vector<PathPiece> pieces;  ///< in walking order, without gaps
};

class WalkGraph {
 public:
  explicit WalkGraph(const dtNavMesh& mesh);

  /// Shortest path from `start` to any of `goals`; nullopt where none is reachable. Thread-safe.
  std::optional<WalkPath> FindShortest(const SurfacePoint& start,
                                       std::span<const SurfacePoint> goals) const;

 private:
  friend class WalkSearch;
  struct Portal {
    Vector2d right, left;  // as seen when leaving the polygon
    int right_id = 0, left_id = 0;
    bool right_is_corner = false, left_is_corner = false;  // an obstacle may begin there
    int to = -1;                                           // polygon
    int back = -1;                                         // the same portal in `to`, or -1
  };
  struct Polygon {
    dtPolyRef ref = 0;
    int island = -1;  // connected polygons have the same
    std::vector<Portal> portals;
  };

  void AddPortals(const dtMeshTile& tile, const dtPoly& poly,
                  const std::vector<char>& is_border_vertex, std::vector<Portal>& portals);
  void LinkPortals();
  void NumberIslands();
  int PointId(const float* v);

  std::vector<Polygon> polygons_;
  std::unordered_map<dtPolyRef, int> index_of_;
  std::unordered_map<std::uint64_t, int> point_ids_;  // looked up, never iterated
  int point_count_ = 0;
};

}  // namespace crossnav::sim
