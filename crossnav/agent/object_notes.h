// SPDX-License-Identifier: MIT
// Records of objects as the agent keeps them: from detections of every frame, and what contradicts
// them. They are kept in every mode; decisions read them where a memory was loaded.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/agent/passing_sights.h"
#include "crossnav/agent/state.h"
#include "crossnav/core/observation.h"

namespace crossnav::agent {

inline constexpr double kSameObject_m = 0.5;  // chosen: of a record and a POI of one object

/// Index of the record of the object at a point.
std::optional<std::size_t> RecordAt(const World& world, const std::string& category,
                                    const Vector3d& p_world);

/// Sightings of the goal, without objects that were rejected.
struct GoalSight {
  const std::string& name;
  const std::vector<perception::Detection>& detections;
  const std::vector<policy::Sighting>& sightings;
};

/// Notes the sightings of one frame, of the goal and in passing, and doubts objects that the frame
/// does not show. Under memory.mode = revise, remembered places of the goal that turn out empty
/// are settled from afar. Says in the goal's events which objects count as gone now.
void NoteObjects(const GoalSight& own, const std::vector<PassingSight>& passing,
                 const Observation& obs, World* world, GoalState* goal);

}  // namespace crossnav::agent
