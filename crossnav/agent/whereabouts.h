// SPDX-License-Identifier: MIT
// Where the goal may be under memory.mode = revise: places of the memory that are still believed,
// and the odds of every room for what is not at any of them. World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// memory.mode = revise, and a profile that follows it.
bool IsRevising(const Config& config);

/// The map's evidence with counts, as far as it has none, so that what is seen through is cleared
/// (map.clearing = evidence).
Result<void> CountEvidence(geometry::VoxelMap* map);

/// The rooms of a loaded map.
Revision RevisionOf(const World& world);

/// Floor and room of every record by the loaded map.
void LocateObjects(World* world);

/// Leaves out places that records or the map contradict; adds records that no place covers.
std::vector<HistoryPoi> Revised(std::vector<HistoryPoi> places, const World& world,
                                const GoalState& goal);

/// Brings `goal.full.search` up to date.
void UpdateSearch(StepState& now);

/// Share of the best room's odds that the room about `p_world` has; 1 without a search.
double SearchWorth(const Situation& now, const Vector3d& p_world);

/// Nothing was found where nearly everything was looked at: the goal is gone.
bool IsSurelyAbsent(const Situation& now);

}  // namespace crossnav::agent
