// SPDX-License-Identifier: MIT
// The flights that were walked (paper, "previously confirmed stair connections"): one record each,
// whichever way and however often it was taken.
#pragma once

#include <vector>

#include "crossnav/geometry/stair_flight.h"
#include "crossnav/policy/stair_evidence.h"

namespace crossnav::policy {

/// Notes a walk from one level to another. `way_world`: foot positions, from the last on flat
/// ground before to the first after, at least two. Gives the record: a new one, or that of the
/// flight whose ends it shares.
const geometry::StairFlight& NoteWalk(const std::vector<Vector3d>& way_world,
                                      const StairEvidence& evidence, double voxel_m,
                                      std::vector<geometry::StairFlight>* flights);

/// Surface voxels that were seen as a stair on or beside the flight: what walking it promotes to
/// STAIR (paper, "Stair-State Promotion").
std::vector<VoxelKey> EvidenceOn(const geometry::StairFlight& flight, const StairEvidence& evidence,
                                 double voxel_m);

/// Whether `p_world` lies on the flight or within a metre of it.
bool IsBeside(const geometry::StairFlight& flight, const Vector3d& p_world);

/// Share of `points` with a voxel of stair evidence under or beside the foot [0, 1].
double EvidenceShare(const std::vector<Vector3d>& points_world, const StairEvidence& evidence,
                     double voxel_m);

}  // namespace crossnav::policy
