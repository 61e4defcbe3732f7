// SPDX-License-Identifier: MIT
// Triangles onto the pixels of a pinhole camera, eight lanes at a time (Highway, chosen at run
// time; operations come in one order and are not fused: the same picture on every processor).
// Internal.
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
