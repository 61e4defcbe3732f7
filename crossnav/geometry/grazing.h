// SPDX-License-Identifier: MIT
// Surfaces between pixels (map.clearing = evidence). On a wall seen at a grazing angle neighbouring
// rays end voxels apart, and each passes in front of the voxels between: that says nothing against
// them, since the surface runs through them from end to end. Such voxels are spared. A ray that
// ends on something else behind is not a neighbour in this sense, so what has moved away still
// goes. Internal to the map.
#pragma once

#include "crossnav/geometry/end_rows.h"
#include "crossnav/geometry/integrate.h"

namespace crossnav::geometry {

/// Adds to map.gaps the pixel pairs of the row, and between the row and the one above it, whose end
/// voxels do not share a face. `above` is null for the first row.
void FindGaps(MapData& map, int v, int width, const RowEnds& row, const RowEnds* above);

/// Takes the occupied voxels between the ends of map.gaps out of what the frame passed.
void SpareSurfacesInGaps(MapData& map, const DepthFrame& frame);

}  // namespace crossnav::geometry
