// SPDX-License-Identifier: MIT
// How much a set of surface voxels looks like a stair: the four cues of the paper's "Support-Aware
// Voxel Types", each in [0, 1]. Also tells flat ground from a flight. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/policy/candidates.h"

namespace crossnav::policy {

struct StairGeometry {
  double height_variation = 0;  ///< rise inside the 1 m neighbourhood
  double step_trend = 0;        ///< slope of 20 to 50 degrees, small residual
  double continuity = 0;        ///< share of the largest connected part
  double head_room = 0;         ///< share of surface voxels with free air above
  double Score() const { return (height_variation + step_trend + continuity + head_room) / 4; }
};

/// `voxels` sorted. Empty or tiny sets score 0.
StairGeometry ScoreStairGeometry(const VoxelMap& map, const std::vector<VoxelKey>& voxels);

/// Highest voxel of each column of a sorted set: treads, without risers and sides.
std::vector<VoxelKey> ColumnTops(const std::vector<VoxelKey>& sorted);

/// Least-squares plane z = gradient . (x, y) + c through voxel centres.
struct PlaneFit {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< rise per metre
  double residual_m = 0;                               ///< root mean square
  int count = 0;
};
PlaneFit FitPlane(const std::vector<VoxelKey>& voxels, double voxel_m);

/// Supports of the columns within `radius_m` of `p_world_foot`, up to one climb above or below it.
std::vector<VoxelKey> SupportsAround(const VoxelMap& map, const Vector3d& p_world_foot,
                                     double radius_m);

/// True where the ground around the agent is level enough to be a landing rather than a flight.
bool IsFlatAround(const VoxelMap& map, const Vector3d& p_world_foot);

}  // namespace crossnav::policy
