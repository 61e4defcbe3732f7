// SPDX-License-Identifier: MIT
#include "crossnav/geometry/flying_pixels.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace crossnav::geometry {
namespace {

constexpr float kSlope = 0.03F;        // chosen: of the depth
constexpr float kNoise_per_m = 0.01F;  // chosen: 2.7 sigma of a RealSense

constexpr std::array<std::pair<int, int>, 8> kNeighbours = {
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

float ToleranceAt(float z_m) {
  return (kSlope + kNoise_per_m * z_m) * z_m;
}

float KeptAt(const DepthImage& depth_m, int u, int v, int min_neighbours) {
  const float z_m = depth_m.At(u, v);
  int confirming = 0;
  for (const auto& [du, dv] : kNeighbours)
    if (depth_m.Contains(u + du, v + dv) &&
        std::abs(depth_m.At(u + du, v + dv) - z_m) <= ToleranceAt(z_m))
      ++confirming;
  return z_m > 0 && confirming < min_neighbours ? 0 : z_m;
}

/// Pixels with eight neighbours of row `v`. The loop has no branches, so that it becomes vector
/// instructions.
void KeepInside(const DepthImage& depth_m, int v, int min_neighbours, DepthImage& kept) {
  std::array<std::ptrdiff_t, 8> steps{};
  for (std::size_t i = 0; i < steps.size(); ++i)
    steps[i] = std::ptrdiff_t{kNeighbours[i].second} * depth_m.width + kNeighbours[i].first;
  const float* const row = &depth_m.At(0, v);
  float* const out = &kept.At(0, v);
  for (int u = 1; u + 1 < depth_m.width; ++u) {
    const float z_m = row[u], tolerance_m = ToleranceAt(z_m);
    int confirming = 0;
    for (const std::ptrdiff_t step : steps)
      confirming += std::abs(row[u + step] - z_m) <= tolerance_m ? 1 : 0;
    out[u] = (z_m > 0) & (confirming < min_neighbours) ? 0 : z_m;
  }
}

}  // namespace

DepthImage WithoutFlyingPixels(const DepthImage& depth_m, int min_neighbours) {
  DepthImage kept(depth_m.width, depth_m.height, 0.0F);
  for (int v = 0; v < depth_m.height; ++v) {
    const bool is_inside = v > 0 && v + 1 < depth_m.height && depth_m.width > 2;
    if (is_inside) KeepInside(depth_m, v, min_neighbours, kept);
    const int step = is_inside ? depth_m.width - 1 : 1;  // its two ends, or all of a border row
    for (int u = 0; u < depth_m.width; u += step)
      kept.At(u, v) = KeptAt(depth_m, u, v, min_neighbours);
  }
  return kept;
}

}  // namespace crossnav::geometry
