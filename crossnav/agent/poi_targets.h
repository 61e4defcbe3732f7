// SPDX-License-Identifier: MIT
// Where to stand to look at an object or at a remembered place, over the ground of all floors.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/planner/ground_search.h"

namespace crossnav::agent {

/// A candidate with the way to it.
struct GroundTarget {
  policy::Candidate candidate;
  std::vector<geometry::VoxelKey> path;
  double cost_m = 0;
  double score_m = 0;  ///< cost and what its class adds; lower is better
};

/// What may be walked on: every floor, or the start level alone for the planar variant.
planner::GroundRules RulesOf(const Situation& now);

/// The nearest place from which enough of `object` is in view within `range_m`; `tried` are places
/// not to offer again.
std::optional<GroundTarget> NearestView(const Situation& now, const geometry::VoxelKey& start,
                                        const std::vector<geometry::VoxelKey>& object,
                                        double range_m, const std::vector<Vector3d>& tried);

/// The reachable place nearest to `p_world` on its own storey, if it is nearer than `start`.
std::optional<GroundTarget> NearestTo(const Situation& now, const geometry::VoxelKey& start,
                                      const Vector3d& p_world);

/// The best live POI that can be approached.
std::optional<GroundTarget> ChooseLivePoi(const Situation& now, const geometry::VoxelKey& start);

/// The remembered place to visit next.
std::optional<GroundTarget> ChooseHistoryPoi(const Situation& now, const geometry::VoxelKey& start);

}  // namespace crossnav::agent
