// SPDX-License-Identifier: MIT
// Scans: turns on the spot that show unseen ground.
#pragma once

#include <deque>
#include <optional>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// Interrupts the pursuit by `turns`. Replaces a scan in progress; nothing happens without turns.
void BeginScan(StepState& now, std::deque<Action> turns);
/// Ends the scan, if there is one, and resumes the suspended pursuit.
void EndScan(StepState& now);

/// Tries a step in every heading, until the body moves: the way out of a place that the map takes
/// for closed.
void BeginEscape(StepState& now);
/// Whether the scan is an escape that moved the body.
bool HasEscaped(const Situation& now, const Scan& scan);

/// Begins a full turn with the camera down at the ground.
void LookAround(StepState& now);

/// Begins a full turn with the camera up: what was overhead on an earlier day may be gone, and the
/// camera that looks down at the ground does not see it. False if the camera is fixed.
bool LookUp(StepState& now);

/// Turns towards much unseen ground in sight that was not looked at from `start`. Empty if there is
/// none.
std::deque<Action> GlanceFrom(const Situation& now, const geometry::VoxelKey& start);

}  // namespace crossnav::agent
