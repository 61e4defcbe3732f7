// SPDX-License-Identifier: MIT
// Flights judged by their run. A rise with a too high column behind it is the front of a seat, or a
// riser of a flight with short treads; the rises before and behind it decide.
#pragma once

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::planner {

using geometry::VoxelKey;

class GroundMap;

/// Radius in columns, per axis, that IsStepOfFlight reads.
int RunReach_vox(double voxel_m);

/// Whether a column behind `to` is too high for a foot that steps up from the neighbouring place
/// `from`.
bool IsHighBehind(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to);

/// Whether the rise from `from` to its neighbour `to` belongs to a run: at least three consecutive
/// rises along the line of the step, on treads neither too short to stand on nor as deep as a seat.
/// Rises above with a visible front alone count.
bool IsStepOfFlight(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to);

}  // namespace crossnav::planner
