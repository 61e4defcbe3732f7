// SPDX-License-Identifier: MIT
// Surfaces between pixels (map.clearing = evidence). On a wall seen at a grazing angle
// neighbouring rays end voxels apart, and each passes through voxels that the wall occupies
// between the two ends. These voxels keep their evidence. A ray that ends on another surface
// behind does not count as a neighbour, so that objects that moved away are still cleared.
// Internal to the map.
#pragma once

#include "crossnav/geometry/integrate.h"

namespace crossnav::geometry {

/// kWhereContested restricts the search to the few pixels that may show a passed occupied voxel;
/// the result is the same.
enum class GapSearch { kWhereContested, kEverywhere };

/// Removes occupied voxels between the ends of neighbouring pixels from the frame's passed voxels.
void SpareSurfacesInGaps(MapData& map, const DepthFrame& frame,
                         GapSearch search = GapSearch::kWhereContested);

}  // namespace crossnav::geometry
