// SPDX-License-Identifier: MIT
// Faces of risers in one depth picture. A tread that is seen edge-on, or of which a strip is seen,
// is known by the face below it. World frame, z up, metres.
#pragma once

#include <vector>

#include "crossnav/geometry/depth_surface.h"

namespace crossnav::geometry {

/// An upright face as high as a riser.
struct RiserFace {
  Vector3d normal_world = Vector3d::Zero();  ///< level, unit length, down the flight
  double front_m = 0;                        ///< along -normal_world
  double low_m = 0, high_m = 0;              ///< heights of its lower and upper edge
  double left_m = 0, right_m = 0;            ///< along normal_world x z
  std::vector<int> pixels;
};

/// By low_m. `surface` is level.
std::vector<RiserFace> FindRiserFaces(const DepthSurface& surface);

}  // namespace crossnav::geometry
