// SPDX-License-Identifier: MIT
// Colour of another camera, brought onto the grid of depth.
#pragma once

#include "crossnav/core/observation.h"

namespace crossnav {

constexpr double kColourFarPlane_m = 10;  // chosen: depth cameras leave holes where it is far

/// True where colour comes from a camera of its own.
inline bool HasOwnColourGrid(const Observation& obs) {
  return obs.rgb_camera.width_px > 0;
}

/// The observation with its colour on the grid of depth: for each depth pixel the nearest sample of
/// the colour image. Pixels without depth are taken to lie on a plane kColourFarPlane_m away; what
/// lies outside the colour image is black. What the colour camera does not see gets the colour of
/// what hides it. `obs` must have a colour grid of its own. Cost O(pixels of depth).
Observation WithColourOnDepthGrid(const Observation& obs);

}  // namespace crossnav
