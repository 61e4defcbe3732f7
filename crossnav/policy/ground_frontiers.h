// SPDX-License-Identifier: MIT
// Frontiers of the ground, at every height: places to stand beside a column where ground may be and
// was not seen yet (paper, "Candidate Navigation Points"). Air whose floor is hidden is a frontier
// like the unknown; a drop that was seen is none, since what can be stepped down to is ground.
#pragma once

#include <set>
#include <vector>

#include "crossnav/planner/ground_map.h"
#include "crossnav/policy/candidates.h"

namespace crossnav::policy {

/// Whether `key`, a place to stand, has unseen ground beside it; `beyond` gets that voxel.
bool IsGroundFrontier(const planner::GroundMap& ground, const VoxelKey& key, VoxelKey* beyond);

/// The frontier places connected to `seed` by neighbouring columns within the climb limit, sorted,
/// each with what it borders on. `visited` gets them all; those in it already are left out.
Candidate GroundFrontierAround(const planner::GroundMap& ground, const VoxelKey& seed,
                               std::set<VoxelKey>* visited);

}  // namespace crossnav::policy
