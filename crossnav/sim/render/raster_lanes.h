// SPDX-License-Identifier: MIT
// Rasterizer kernel: triangles onto the pixels of a pinhole camera, eight lanes at a time (Highway,
// chosen at run time). Internal.
//
// Scalar code for one triangle (a, b, c), camera at the origin, coordinates scaled to pixels:
//   1. Lines c x b, a x c, b x a. Weight k at pixel (u, v) is line_k . (u, v, 1), with the sign
//      that makes all three >= 0 inside.
//   2. Inverse depth at (u, v): normal . (u, v, 1) / (normal . a), clamped to the corners' range.
//   3. Each pixel of the triangle's box with weights >= 0 and an inverse depth above the stored
//      value shows this triangle, unless the place is a hole.
// Tiles and blocks store lower bounds of the inverse depth and only skip pixels that cannot change.
// References: every triangle against every ray (tests/sim/ray_oracle.h, used by the tests of
// Rasterizer) and Embree. Operations come in one order and are not fused: every processor gives the
// same picture.
#pragma once

#include <cstdint>
#include <functional>

#include "crossnav/sim/render/canvas.h"
#include "crossnav/sim/render/triangle_clusters.h"

namespace crossnav::sim {

/// Whether a place on a triangle, by the weights of its second and third corner, is a hole.
using HoleTest = std::function<bool(std::uint32_t triangle, float s, float t)>;

/// Skips clusters outside the picture or behind drawn pixels.
void DrawClusters(const TriangleClusters& triangles, const RasterView& view,
                  const HoleTest& is_hole, Canvas& canvas);

}  // namespace crossnav::sim
