// SPDX-License-Identifier: MIT
// Derives the states of a block from the evidence around it: eq:supp_support_classification and
// inflation, 64 voxels at a time. A pure function of the evidence, so that bringing stale blocks up
// to date equals a full rebuild. Internal to the map.
#pragma once

#include <vector>

#include "crossnav/geometry/map_data.h"

namespace crossnav::geometry {

/// Blocks with states that may depend on map.changed; empties that list.
std::vector<GridEntry*> TakeStaleBlocks(MapData& map);

/// Recomputes the entry's states and appends the changes. Cost: a microsecond or two.
void ClassifyBlock(const MapData& map, GridEntry& entry, std::vector<StateChange>* changes);

/// Sorts by key.
void SortChanges(std::vector<StateChange>* changes);

}  // namespace crossnav::geometry
