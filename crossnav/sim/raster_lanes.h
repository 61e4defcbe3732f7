// SPDX-License-Identifier: MIT
// Triangles onto the pixels of a pinhole camera, eight lanes at a time (Highway, chosen at run
// time; operations come in one order and are not fused: the same picture on every processor).
// Internal.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "crossnav/sim/shade_lanes.h"
#include "crossnav/sim/triangle_clusters.h"

namespace crossnav::sim {

/// A triangle that some pixel was given to: 32 words, so that lanes can gather them.
struct alignas(128) Drawn {
  /// By corner: what its weight is at pixel (u, v) as a u + b v + c, all three up to one factor.
  std::array<float, 9> weights{};
  std::array<float, 3> normal{};  ///< world, any length
  std::uint32_t triangle = 0;     ///< of the mesh
  std::int32_t instance = 0;
  std::array<double, 5> plane{};  ///< of SeenPlane: normal, rise, least
};

/// Which triangle every pixel shows.
struct Canvas {
  int width = 0, height = 0;         ///< [px]
  int stride = 0;                    ///< pixels from row to row, more than wide by a vector
  std::vector<float> inverse_depth;  ///< [1/m], 0 = nothing
  std::vector<std::uint32_t> drawn;  ///< index
  std::vector<Drawn> triangles;

  void Clear(int width_px, int height_px);
};

/// Whether a place on a triangle, by the weights of its second and third corner, is a hole.
using HoleTest = std::function<bool(std::uint32_t triangle, float s, float t)>;

/// Clusters outside the picture or behind what was drawn are left out.
void DrawClusters(const TriangleClusters& triangles, const RasterView& view,
                  const HoleTest& is_hole, Canvas& canvas);

}  // namespace crossnav::sim
