// SPDX-License-Identifier: MIT
#include "crossnav/geometry/flying_pixels.h"

#include <array>
#include <cmath>
#include <utility>

namespace crossnav::geometry {
namespace {

constexpr float kSlope = 0.03F;        // chosen: of the depth
constexpr float kNoise_per_m = 0.01F;  // chosen: 2.7 sigma of a RealSense

// The neighbours beside a pixel come first: most readings need no more.
constexpr std::array<std::pair<int, int>, 8> kNeighbours = {
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

bool IsConfirmed(const DepthImage& depth_m, int u, int v, int min_neighbours) {
  const float z_m = depth_m.At(u, v);
  const float tolerance_m = (kSlope + kNoise_per_m * z_m) * z_m;
  int confirming = 0;
  for (const auto& [du, dv] : kNeighbours)
    if (depth_m.Contains(u + du, v + dv) &&
        std::abs(depth_m.At(u + du, v + dv) - z_m) <= tolerance_m && ++confirming >= min_neighbours)
      return true;
  return min_neighbours == 0;
}

}  // namespace

DepthImage WithoutFlyingPixels(const DepthImage& depth_m, int min_neighbours) {
  DepthImage kept = depth_m;
  for (int v = 0; v < depth_m.height; ++v)
    for (int u = 0; u < depth_m.width; ++u)
      if (depth_m.At(u, v) > 0 && !IsConfirmed(depth_m, u, v, min_neighbours)) kept.At(u, v) = 0;
  return kept;
}

}  // namespace crossnav::geometry
