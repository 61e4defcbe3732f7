// SPDX-License-Identifier: MIT
// Type-aware 3D A* (paper, sec:supp_astar). Nodes are voxels, the cost of an edge is its length in
// voxels plus the type penalty of the voxel it enters (eq:supp_astar_edge_cost), the heuristic is
// the Euclidean distance (eq:supp_astar_heuristic). Costs are those of plain Dijkstra on the same
// graph. World frame; lengths in voxels. Reads the map only.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/planner/planner_config.h"

namespace crossnav::planner {

using geometry::VoxelKey;
using geometry::VoxelMap;

enum class GraphKind {
  kNormal,  ///< 26 neighbours
  kStair,   ///< every pathable endpoint within a metric sphere, for sparse stair observations
};

/// Lowest and highest support that may be walked on [voxels, inclusive].
struct LevelBand {
  int min_z = 0;
  int max_z = 0;
  bool Contains(int z) const { return z >= min_z && z <= max_z; }
};

/// Voxels that a mode may walk on.
struct GraphRules {
  GraphKind kind = GraphKind::kNormal;
  bool allow_inflated = false;     ///< at `inflated_cost_factor` times the cost
  std::optional<LevelBand> level;  ///< Basic Explore stays on its level
  int start_reach_vox = 0;         ///< clear-line reach from the start across
                                   ///< the ring around the feet that the camera cannot see
  const std::set<VoxelKey>* obstacles = nullptr;  ///< temporary, from bumps; may be null
};

enum class PlanStatus {
  kFound,
  kUnreachable,  ///< the whole reachable graph was searched
  kGaveUp,       ///< `max_expansions` ran out first
};

struct Plan {
  PlanStatus status = PlanStatus::kUnreachable;
  std::vector<VoxelKey> path;  ///< start first, goal last; empty unless found
  double cost = 0;             ///< [voxels]
  std::size_t goal_index = 0;  ///< which of the goals was reached
  int expansions = 0;
  bool found() const { return status == PlanStatus::kFound; }
};

/// Cheapest path from `start` to the cheapest of `goals`. Goals that are not targetable are never
/// reached; FAKE_STAIR is passed only as a costly fallback. A start inside inflation may stay in it
/// until the first voxel outside. Cost O(expansions x neighbours).
Plan FindPath(const VoxelMap& map, const VoxelKey& start, std::span<const VoxelKey> goals,
              const GraphRules& rules, const PlannerConfig& config);

/// Start voxel of a plan from `p_world_foot`: the nearest pathable voxel around the feet, inflated
/// or not; nullopt if there is none within half a metre.
std::optional<VoxelKey> StartVoxel(const VoxelMap& map, const Vector3d& p_world_foot);

/// Height index of the first surface below `key` within the support depth; for a surface voxel its
/// own. nullopt where nothing supports.
std::optional<int> SupportZ(const VoxelMap& map, const VoxelKey& key);

}  // namespace crossnav::planner
