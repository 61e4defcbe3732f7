// SPDX-License-Identifier: MIT
// Records of objects as the agent keeps them: from detections of every frame, and what contradicts
// them. They are kept in every mode; decisions read them under memory.mode = revise only.
#pragma once

#include <string>
#include <vector>

#include "crossnav/agent/state.h"
#include "crossnav/core/observation.h"
#include "crossnav/perception/perception.h"
#include "crossnav/policy/live_poi.h"

namespace crossnav::agent {

/// Notes the sightings of one frame, lifted from `detections`, and doubts what the frame does not
/// show. Says in the goal's events what counts as gone now.
void NoteObjects(const std::vector<policy::Sighting>& sightings,
                 const std::vector<perception::Detection>& detections, const Observation& obs,
                 World* world, GoalState* goal);

}  // namespace crossnav::agent
