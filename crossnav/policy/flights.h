// SPDX-License-Identifier: MIT
// Known flights (paper, "previously confirmed stair connections"): one record each, in either
// direction and however often walked; a flight known by stair evidence alone is a record, too.
#pragma once

#include <vector>

#include "crossnav/geometry/stair_flight.h"
#include "crossnav/policy/stair_evidence.h"

namespace crossnav::policy {

/// Notes a walk from one level to another. `path_world`: foot positions, from the last on flat
/// ground before to the first after, at least two. Returns a new record, or the record of the
/// flight with the same ends. Flights along the path that were only seen become part of it.
const geometry::StairFlight& NoteWalk(const std::vector<Vector3d>& path_world,
                                      const StairEvidence& evidence, double voxel_m,
                                      std::vector<geometry::StairFlight>* flights);

/// Surface voxels that were seen as a stair on or beside the flight: a walk promotes them to STAIR
/// (paper, "Stair-State Promotion").
std::vector<VoxelKey> EvidenceOn(const geometry::StairFlight& flight, const StairEvidence& evidence,
                                 double voxel_m);

/// Whether `p_world` lies on the flight or within a metre of it.
bool IsBeside(const geometry::StairFlight& flight, const Vector3d& p_world);
/// Whether most steps of one flight lie beside the other; of flights above each other only a
/// landing's width does.
bool AreSameStairs(const geometry::StairFlight& a, const geometry::StairFlight& b);

/// Notes on the flight beside `p_target_world`, if any, that its pursuit was given
/// up.
void NoteTry(const Vector3d& p_target_world, const geometry::FlightTry& attempt,
             std::vector<geometry::StairFlight>* flights);

/// Adds a place from which the flight was seen, unless a noted place lies within a metre.
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
