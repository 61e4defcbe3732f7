// SPDX-License-Identifier: MIT
// Noise of a real depth camera from its frames alone, without the truth: how readings lie about the
// planes of their neighbours, where depth is missing, and depths at edges.
#pragma once

#include <array>
#include <vector>

#include "crossnav/core/observation.h"

namespace crossnav::evaluation {

inline constexpr std::array<double, 5> kDistances_m = {0.5, 1, 2, 3, 5};   // edges of bins
inline constexpr std::array<double, 5> kAngles_deg = {0, 30, 60, 75, 90};  // likewise
inline constexpr std::array<int, 4> kLights = {16, 32, 64, 256};           // upper ends

struct DepthStatistics {
  /// Residuals to the plane of the 7 x 7 pixels around [m], by distance and by angle.
  std::array<std::array<std::vector<double>, 4>, 4> residuals_m;
  std::array<std::int64_t, 4> lit{}, lost{};  ///< pixels by light, and pixels without depth
  std::int64_t edges = 0;                     ///< pixels within a jump
  std::int64_t flying = 0;                    ///< of these: between both sides

  /// 1.48 times the median of the absolute residuals; 0 with fewer than 100.
  double SigmaOf(int distance, int angle) const;
};

/// Every third pixel of a row and column. Light is counted where colour is on the grid of depth.
void AddFrame(const Observation& obs, DepthStatistics* statistics);

}  // namespace crossnav::evaluation
