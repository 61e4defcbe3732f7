// SPDX-License-Identifier: MIT
// Weight of a frontier against its path (policy.explore.scoring): the unseen ground that
// lies open beyond it, and the relevancy of its surroundings to the goal. World frame,
// metres.
#pragma once

#include <span>
#include <unordered_map>

#include "crossnav/memory/semantic_memory.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::policy {

/// Area of the unseen ground that lies open beside `place` [m2]: along straight lines of at most
/// `range_m`, up to the first observed voxel. The area behind a chair is a pocket, the area behind
/// a door is a room.
double UnseenBeyond(const planner::GroundMap& ground, const geometry::VoxelKey& place,
                    double range_m);

/// How much the surroundings of a place resemble the goal: in coarse cells, the best answer of the
/// memory's rows to the goal's text, between that of the median row (0) and that of the best (1).
class Relevancy {
 public:
  /// `similarity`: cosine of every row of `memory` with the text.
  void Refresh(const memory::SemanticMemory& memory, std::span<const float> similarity);
  /// Mean over the cells that hold rows within about two metres and half a storey; 0 where none do.
  double Around(const Vector3d& p_world) const;

 private:
  std::unordered_map<geometry::VoxelKey, float, geometry::VoxelKeyHash> best_;  // of a cell
};

/// Weight of a frontier in (0, 1]: 1 with `scoring = nearest`; unseen area as a share
/// of a room's with `area`; that, up to doubled by relevancy to the goal, with
/// `semantic`.
double FrontierWorth(const planner::GroundMap& ground, const geometry::VoxelKey& place,
                     const Relevancy& relevancy, const ExploreConfig& config);

}  // namespace crossnav::policy
