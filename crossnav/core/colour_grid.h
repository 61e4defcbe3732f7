// SPDX-License-Identifier: MIT
// Registers the colour of a separate camera to the grid of depth.
#pragma once

#include "crossnav/core/observation.h"

namespace crossnav {

constexpr double kColourFarPlane_m = 10;  // chosen: depth cameras leave holes beyond this range

/// True where colour has its own camera.
inline bool HasOwnColourGrid(const Observation& obs) {
  return obs.rgb_camera.width_px > 0;
}

/// Observation with its colour on the grid of depth: the nearest sample of the colour image for
/// each depth pixel. Pixels without depth are placed on a plane kColourFarPlane_m away; pixels
/// outside the colour image are black. A surface hidden from the colour camera gets the colour of
/// its occluder. `obs` must have its own colour grid. Cost O(pixels of depth).
Observation WithColourOnDepthGrid(const Observation& obs);

}  // namespace crossnav
