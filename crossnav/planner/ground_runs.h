// SPDX-License-Identifier: MIT
// Flights judged by their run. A rise whose next column is too high for the same foot is the front
// of a seat, or one riser of a flight with short treads: the rises before and behind it decide.
#pragma once

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::planner {

using geometry::VoxelKey;

class GroundMap;

/// Columns along one axis around a place that IsStepOfFlight may look at.
int RunReach_vox(double voxel_m);

/// Whether something behind `to` is too high for the foot that steps up to it from the neighbouring
/// place `from`.
bool IsHighBehind(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to);

/// Whether the rise from `from` to its neighbour `to` is one of at least three that follow each
/// other along the line of the step, each on a tread that is neither too short to stand on nor as
/// deep as a seat. Rises above that show only their front count.
bool IsStepOfFlight(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to);

}  // namespace crossnav::planner
