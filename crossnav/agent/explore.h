// SPDX-License-Identifier: MIT
// Exploration: the place to go to when no POI is known. One search over the ground of all floors in
// order of path cost; the candidates at each place (exploration_candidates.h) and their prices
// (exploration_prices.h) give the cheapest target. The paper's strict order is the limit of large
// prices.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

struct ExplorationChoice {
  std::optional<GroundTarget> target;    ///< the best; empty if there is none
  std::vector<policy::Candidate> shown;  ///< candidates met before the best was certain
  /// The level is known to have a flight down, and was not before.
  bool has_found_descent = false;
  std::optional<policy::Relevancy> relevancy;  ///< refreshed, scoring = semantic
};
ExplorationChoice ChooseExploration(const Situation& now, const geometry::VoxelKey& start);

/// Whether the reason for `candidate` still holds: a frontier is open, ground is uninspected.
bool IsStillOpen(const Situation& now, const policy::Candidate& candidate);

/// Whether a path to the place leads over stairs, as far as the map tells: stairs were seen there,
/// or the place is a storey away. A mere rise may be a seat or a slope.
bool IsOverStairs(const Situation& now, const Vector3d& p_world);

/// Whether a place at this height belongs to the exploration level.
bool IsOnLevel(const Situation& now, const Vector3d& p_world);

}  // namespace crossnav::agent
