// SPDX-License-Identifier: MIT
#include "crossnav/policy/goal_length.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace crossnav::policy {

using geometry::VoxelKey;

namespace {

struct GoalLength {
  std::string_view goal;
  double least_m;
};

// chosen: sofas of two seats are 1.4 m long, wide armchairs 1.2 m; both gain a voxel in the map.
// Beds, tables and the like have short relatives of the same name.
constexpr std::array kLeast = {GoalLength{"sofa", 1.3}};
constexpr double kUnsure_m = 0.1;  // chosen: a voxel, to either side

}  // namespace

double LengthOf(const std::vector<VoxelKey>& voxels, double voxel_m) {
  constexpr double kTrimmed = 0.03;  // chosen: masks reach that far over an edge, at either end
  constexpr int kDirections = 9;     // chosen: every 10 degrees of the first quarter
  if (voxels.empty()) return 0;
  const auto extent_vox = [&](double angle_rad) {
    const double cosine = std::cos(angle_rad), sine = std::sin(angle_rad);
    std::vector<double> along;
    for (const VoxelKey& key : voxels) along.push_back(cosine * key.x + sine * key.y);
    const auto trimmed = static_cast<std::ptrdiff_t>(kTrimmed * static_cast<double>(along.size()));
    std::nth_element(along.begin(), along.begin() + trimmed, along.end());
    const double low = along[static_cast<std::size_t>(trimmed)];
    std::nth_element(along.begin(), along.end() - 1 - trimmed, along.end());
    return *(along.end() - 1 - trimmed) - low + 1;
  };
  double least_area = std::numeric_limits<double>::infinity(), length_vox = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = i * M_PI / 2 / kDirections;
    const double a = extent_vox(angle_rad), b = extent_vox(angle_rad + M_PI / 2);
    if (a * b >= least_area) continue;
    least_area = a * b;
    length_vox = std::max(a, b);
  }
  return length_vox * voxel_m;
}

double ShortnessOf(std::string_view goal, double length_m) {
  const auto* const it =
      std::find_if(kLeast.begin(), kLeast.end(), [&](const auto& row) { return row.goal == goal; });
  if (it == kLeast.end()) return 0;
  return std::clamp(0.5 - (length_m - it->least_m) / (2 * kUnsure_m), 0.0, 1.0);
}

}  // namespace crossnav::policy
