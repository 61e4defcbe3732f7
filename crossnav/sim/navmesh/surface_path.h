// SPDX-License-Identifier: MIT
// A path in plan view -> points on the walkable surface. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/sim/navmesh/walk_graph.h"

namespace crossnav::sim {

struct PathPoint {
  Vector3d p;
  bool is_corner = false;  ///< start, turning point or goal
};

/// Points at most 0.05 m apart, first = `a`, last = `b`. Heights are the detail mesh's, smoothed
/// over 0.6 m: a flight counts as the ramp through its treads. The same path backwards has the same
/// length.
std::vector<PathPoint> LiftPath(const dtNavMeshQuery& query, const WalkPath& path,
                                const Vector3d& a, const Vector3d& b);

/// The corners, and as many other points as the heights need to within 0.1 m.
std::vector<Vector3d> KeepShape(const std::vector<PathPoint>& points);

}  // namespace crossnav::sim
