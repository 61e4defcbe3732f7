// SPDX-License-Identifier: MIT
// Where to look next when no place is known that may hold the goal: one sweep over the ground in
// order of cost, on all floors, in which each class of candidates must be nearer than a frontier of
// this level by what the class costs. The paper's order is the limit of large class costs.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

/// The best target; `shown` gets the candidates that were met before it was certain.
std::optional<GroundTarget> ChooseExploration(Situation& now, const geometry::VoxelKey& start,
                                              std::vector<policy::Candidate>* shown);

/// Whether what made `candidate` a target still holds.
bool IsStillOpen(const Situation& now, const policy::Candidate& candidate);

/// Whether the way there is one over stairs, for all the agent knows: to a place where stairs were
/// seen, or a storey away. What merely rises may be a seat or a slope.
bool IsOverStairs(const Situation& now, const Vector3d& p_world);

/// Whether a place at this height belongs to the level that is being explored.
bool IsOnLevel(const Situation& now, const Vector3d& p_world);

}  // namespace crossnav::agent
