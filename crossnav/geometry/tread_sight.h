// SPDX-License-Identifier: MIT
// Treads and landings that a frame does not see from above (map.clearing = evidence). The surface
// of a tread may be the bottom face of its voxel: a ray from below the flight, or a flat one,
// passes over it through the voxel and contradicts nothing. Internal to the map.
#pragma once

#include "crossnav/geometry/integrate.h"

namespace crossnav::geometry {

/// Removes from the frame's passed voxels those stairs that the camera does not look down on.
void SpareTreads(MapData& map, const DepthFrame& frame);

}  // namespace crossnav::geometry
