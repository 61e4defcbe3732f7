// SPDX-License-Identifier: MIT
// Flying pixels: beside an edge a depth camera receives light of both sides in one pixel and reads
// a depth between them, where nothing is (Sarbolandi, Lefloch, Kolb, CVIU 2015). In a map they
// stand in free air before doors and furniture.
#pragma once

#include "crossnav/core/image.h"

namespace crossnav::geometry {

/// The image with 0 in place of each reading that fewer than two of its eight neighbours confirm.
/// A neighbour confirms within 3 % and 0.01 z^2 of the depth z [m]: the slope of a surface, and the
/// noise of a stereo camera.
DepthImage WithoutFlyingPixels(const DepthImage& depth_m);

}  // namespace crossnav::geometry
