// SPDX-License-Identifier: MIT
// Surfaces between pixels (map.clearing = evidence). On a wall seen at a grazing angle neighbouring
// rays end voxels apart, and each passes in front of the voxels between: that says nothing against
// them, since the surface runs through them from end to end. Such voxels are spared. A ray that
// ends on something else behind is not a neighbour in this sense, so what has moved away still
// goes. Internal to the map.
#pragma once

#include "crossnav/geometry/integrate.h"

namespace crossnav::geometry {

/// kWhereContested looks only at the pixels in which occupied voxels that were passed may be seen,
/// few of all; with the same result.
enum class GapSearch { kWhereContested, kEverywhere };

/// Takes the occupied voxels between the ends of neighbouring pixels out of what the frame passed.
void SpareSurfacesInGaps(MapData& map, const DepthFrame& frame,
                         GapSearch search = GapSearch::kWhereContested);

}  // namespace crossnav::geometry
