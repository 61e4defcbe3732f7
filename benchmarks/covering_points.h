// SPDX-License-Identifier: MIT
// Places from which a whole scene is seen, for programs that explore without a policy.
#pragma once

#include <algorithm>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/core/rng.h"
#include "crossnav/sim/navmesh/navmesh.h"

namespace crossnav {

/// Points that cover the navmesh, no two nearer than `spacing_m`; ends after `misses` consecutive
/// points that are nearer than that to an accepted point.
inline std::vector<Vector3d> CoveringPoints(const sim::NavMesh& navmesh, double spacing_m,
                                            int misses) {
  Rng rng(5);
  std::vector<Vector3d> kept;
  for (int missed = 0; missed < misses;) {
    const auto p = navmesh.RandomPoint(rng);
    if (!p) break;
    const bool is_near = std::any_of(
        kept.begin(), kept.end(), [&](const Vector3d& q) { return (q - *p).norm() < spacing_m; });
    missed = is_near ? missed + 1 : 0;
    if (!is_near) kept.push_back(*p);
  }
  return kept;
}

/// Poses of a robot that looks around at these points: six directions, level and 30 degrees down in
/// turn.
inline std::vector<AgentPose> LooksFrom(const std::vector<Vector3d>& points) {
  constexpr int kYaws = 6;
  std::vector<AgentPose> poses;
  for (const Vector3d& p : points)
    for (int yaw = 0; yaw < kYaws; ++yaw)
      poses.push_back({p, yaw * 2 * M_PI / kYaws, yaw % 2 == 0 ? 0 : DegToRad(-30)});
  return poses;
}

}  // namespace crossnav
