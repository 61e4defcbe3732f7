// SPDX-License-Identifier: MIT
// Frontiers of the ground, at every height: places to stand beside a column where ground may be and
// was not seen yet (paper, "Candidate Navigation Points"). Air whose floor is hidden is a frontier
// like the unknown; an observed drop is none, since ground within a step down is not a drop.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "crossnav/planner/ground_map.h"
#include "crossnav/policy/candidates.h"

namespace crossnav::policy {

/// Whether `key`, a place to stand, has unseen ground beside it; `beyond` gets that voxel.
bool IsGroundFrontier(const planner::GroundMap& ground, const VoxelKey& key, VoxelKey* beyond);
/// The same of a place by its index.
bool IsGroundFrontier(const planner::GroundMap& ground, std::int32_t place, VoxelKey* beyond);

/// The frontier places connected to `seed` by neighbouring columns within the climb limit, sorted,
/// each with its unseen column. `visited` gets all of them; places already in it are left out.
Candidate GroundFrontierAround(const planner::GroundMap& ground, const VoxelKey& seed,
                               std::set<VoxelKey>* visited);

}  // namespace crossnav::policy
