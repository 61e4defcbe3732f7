// SPDX-License-Identifier: MIT
// A walkable surface as points on a horizontal grid, linked where a step joins them, and its
// connected parts. World frame, metres. Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::sim {

struct SurfaceSample {
  int x = 0, y = 0;                         ///< in cells of the grid
  double z = 0;                             ///< [m]
  std::array<int, 4> next{-1, -1, -1, -1};  ///< +x, +y, -x, -y; -1 = none
};

/// Grid points covered by the triangles, by x, y, z. Neighbours more than 0.3 m apart in height are
/// not linked.
std::vector<SurfaceSample> SampleSurface(std::span<const std::array<Vector3d, 3>> triangles,
                                         double grid_m);

/// Labels connected samples among those with `in(sample index)`; -1 elsewhere. `joined(a, b)` may
/// separate neighbours.
template <class In, class Joined>
std::vector<int> Components(const std::vector<SurfaceSample>& samples, int& count, In&& in,
                            Joined&& joined) {
  std::vector<int> label(samples.size(), -1);
  count = 0;
  std::vector<int> open;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (label[i] >= 0 || !in(i)) continue;
    label[i] = count;
    open.assign(1, static_cast<int>(i));
    while (!open.empty()) {
      const auto at = static_cast<std::size_t>(open.back());
      open.pop_back();
      for (const int neighbour : samples[at].next) {
        if (neighbour < 0) continue;
        const auto next = static_cast<std::size_t>(neighbour);
        if (label[next] >= 0 || !in(next) || !joined(at, next)) continue;
        label[next] = count;
        open.push_back(neighbour);
      }
    }
    ++count;
  }
  return label;
}

template <class In>
std::vector<int> Components(const std::vector<SurfaceSample>& samples, int& count, In&& in) {
  return Components(samples, count, in, [](std::size_t, std::size_t) { return true; });
}

}  // namespace crossnav::sim
