// SPDX-License-Identifier: MIT
// Flying pixels: beside an edge a depth camera receives light of both sides in one pixel and reads
// a depth between them, where nothing is (Sarbolandi, Lefloch, Kolb, CVIU 2015). In a map they
// stand in free air before doors and furniture.
#pragma once

#include "crossnav/core/image.h"

namespace crossnav::geometry {

/// The image with 0 in place of each reading that fewer than `min_neighbours` of its eight
/// neighbours confirm. A neighbour confirms a depth that it has to within the slope of a surface
/// and the noise of a stereo camera.
DepthImage WithoutFlyingPixels(const DepthImage& depth_m, int min_neighbours);

}  // namespace crossnav::geometry
