// SPDX-License-Identifier: MIT
// Ways to a remembered place that the map of an earlier day shows closed, because a door was shut
// then. To the map a shut door is a wall; the memory tells them apart. World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

/// The encoder's text of a door, for a loaded memory.
void LearnDoors(perception::DenseEncoder& encoder, World* world);

/// Where to look whether the way to a remembered place is open today: the end of the least path,
/// over the ground in reach, through one door, and over the ground from which the place is in view.
/// Only with a loaded memory, for places that no path leads to.
/// `unreachable_steps`: HistoryPoi::unreachable_step of each place after the searches of this step.
std::optional<GroundTarget> ChooseClosedWay(
    const Situation& now, const geometry::VoxelKey& start,
    const std::vector<std::optional<int>>& unreachable_steps);

/// Whether a place that is worth a visit still lies beyond reach.
bool IsWayClosed(const Situation& now);

}  // namespace crossnav::agent
