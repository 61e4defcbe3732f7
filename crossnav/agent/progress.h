// SPDX-License-Identifier: MIT
// What the last action did, and how the activity stands: bumps, levels and flights, the way that is
// left, progress, beginnings and endings.
#pragma once

#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

/// A forward step that met something teaches where that is.
void NoteBump(Situation& now);

/// The exploration level is the one that supports the agent, however it got there; a walk from one
/// to another makes a flight known.
void NoteLevel(Situation& now);

/// A turn on the spot, with the camera down at the ground.
void QueueLookAround(Situation& now);

/// Turns towards much unseen ground in sight that was not looked at from here. False if there is
/// none.
bool QueueGlance(Situation& now, const geometry::VoxelKey& start);

/// Length of the way from the agent along `path` [m].
double RemainingOf(const Situation& now, const std::vector<geometry::VoxelKey>& path);
/// Ground distance to the end of the activity's way [m].
double DistanceToEnd(const Situation& now);

/// Takes up `target`, or goes on with it along a new way.
void Begin(Situation& now, ActivityKind kind, GroundTarget target);
/// Ends the activity and writes it into the record of attempts.
void End(Situation& now, Ending ending);

/// Drops what was walked of the way. False if the agent is off it, or something stands on it now.
bool KeepToPath(Situation& now);

/// Counts steps; ends an activity whose way does not get shorter.
void MeasureProgress(Situation& now);

}  // namespace crossnav::agent
