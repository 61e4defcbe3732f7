// SPDX-License-Identifier: MIT
// Things beside the goal that the agent meets in passing: they get records, so that a later goal is
// known before it is asked for. World frame, metres.
#pragma once

#include <string>
#include <vector>

#include "crossnav/agent/state.h"
#include "crossnav/core/observation.h"
#include "crossnav/perception/perception.h"
#include "crossnav/policy/live_poi.h"

namespace crossnav::agent {

/// policy.profile = full: the other profiles are the paper's and the baseline's to the letter.
bool NoticesThings(const Config& config);

/// Rules of sightings. Where a single frame is believed (verify.evidence other than views), a small
/// thing needs fewer voxels than the paper's ten: one side of a vase fills seven, another eleven,
/// depending on where the grid cuts it.
policy::ObjectConfig SightingRules(const Config& config);

/// Detections of a name in a frame, and their sightings in 3D.
struct PassingSight {
  std::string name;
  std::vector<perception::Detection> detections;
  std::vector<policy::Sighting> sightings;
};

/// The benchmark's categories, the goals so far and the names of records, without the goal and
/// without names that the detector does not know.
std::vector<std::string> NamesToNotice(const World& world, const std::string& goal);

/// Asks the detector for all of these names. Errors are the detector's; a name that it does not
/// know is left out from now on.
Result<std::vector<PassingSight>> LookInPassing(perception::PerceptionSuite& perception,
                                                const Observation& obs, const Config& config,
                                                const std::string& goal, World* world);

/// Whether the detector was asked for `goal` in every frame of the run so far.
bool WasNoticedThroughout(const World& world, const std::string& goal);

}  // namespace crossnav::agent
