// SPDX-License-Identifier: MIT
// The flights that are known (paper, "previously confirmed stair connections"): one record each,
// whichever way and however often it was taken; what stair evidence alone tells of is one, too.
#pragma once

#include <vector>

#include "crossnav/geometry/stair_flight.h"
#include "crossnav/policy/stair_evidence.h"

namespace crossnav::policy {

/// Notes a walk from one level to another. `path_world`: foot positions, from the last on flat
/// ground before to the first after, at least two. Gives the record: a new one, or that of the
/// flight whose ends it shares. Flights on the way that were only seen until now become part of it.
const geometry::StairFlight& NoteWalk(const std::vector<Vector3d>& path_world,
                                      const StairEvidence& evidence, double voxel_m,
                                      std::vector<geometry::StairFlight>* flights);

/// Surface voxels that were seen as a stair on or beside the flight: what walking it promotes to
/// STAIR (paper, "Stair-State Promotion").
std::vector<VoxelKey> EvidenceOn(const geometry::StairFlight& flight, const StairEvidence& evidence,
                                 double voxel_m);

/// Whether `p_world` lies on the flight or within a metre of it.
bool IsBeside(const geometry::StairFlight& flight, const Vector3d& p_world);
/// Whether most steps of one lie beside the other. Of two flights one above the other a landing's
/// width does.
bool AreSameStairs(const geometry::StairFlight& a, const geometry::StairFlight& b);

/// Remembers on the flight beside `p_target_world`, if there is one, that the way there was given
/// up.
void NoteTry(const Vector3d& p_target_world, const geometry::FlightTry& attempt,
             std::vector<geometry::StairFlight>* flights);

/// Adds a place from which the flight was seen, unless one lies within a metre.
void AddSeenFrom(const Vector3d& p_world, geometry::StairFlight* flight);
bool IsSeenFrom(const geometry::StairFlight& flight, const Vector3d& p_world);

/// Gives `flight` the id, the places and the tries of `from`, which is the same stairs.
void TakeHistory(geometry::StairFlight from, geometry::StairFlight* flight);

/// An id that none of `flights` has.
int NextId(const std::vector<geometry::StairFlight>& flights);

/// Share of `points` with a voxel of stair evidence under or beside the foot [0, 1].
double EvidenceShare(const std::vector<Vector3d>& points_world, const StairEvidence& evidence,
                     double voxel_m);

}  // namespace crossnav::policy
