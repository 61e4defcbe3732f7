// SPDX-License-Identifier: MIT
// Life of a pursuit: begin, remaining path, checks of the path, progress, end. World frame, metres.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// Starts `pursuit`; a pursuit in progress with the same target continues along the new path. A
/// pursuit with another target is superseded.
void Begin(StepState& now, Pursuit pursuit);

/// Ends the pursuit and adds it to the record of attempts. Nothing happens while idle.
void End(StepState& now, Ending ending);

/// State of the path of the pursuit in progress.
struct PathCheck {
  bool is_near = false;    ///< the agent is on the path
  bool is_closed = false;  ///< a later observation closed a step of it
  std::size_t walked = 0;  ///< places at its front that lie behind the agent
  bool IsOpen() const { return is_near && !is_closed; }
};
PathCheck CheckPath(const Situation& now);
/// Drops the walked part of the path and remembers the revision of the ground.
void UpdatePath(StepState& now, const PathCheck& check);

/// Length of `path` from the agent on [m].
double RemainingOf(const Situation& now, const std::vector<geometry::VoxelKey>& path);
/// Ground distance to the end of the pursuit's path [m]; 0 without a path.
double DistanceToEnd(const Situation& now);

/// Counts steps. Ends a pursuit whose path does not get shorter for too long.
void MeasureProgress(StepState& now);

/// Places from which approaches to the object about `p_object_world` made no progress.
std::vector<Vector3d> StuckApproaches(const Situation& now, const Vector3d& p_object_world);

}  // namespace crossnav::agent
