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
  constexpr int kDirections = 18;  // chosen: every 10 degrees, 2 % of the length at most
  if (voxels.empty()) return 0;
  double longest_vox = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double cosine = std::cos(i * M_PI / kDirections);
    const double sine = std::sin(i * M_PI / kDirections);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const VoxelKey& key : voxels) {
      const double along = cosine * key.x + sine * key.y;
      low = std::min(low, along);
      high = std::max(high, along);
    }
    longest_vox = std::max(longest_vox, high - low);
  }
  return (longest_vox + 1) * voxel_m;
}

double ShortnessOf(std::string_view goal, const std::vector<VoxelKey>& voxels, double voxel_m) {
  const auto* const it =
      std::find_if(kLeast.begin(), kLeast.end(), [&](const auto& row) { return row.goal == goal; });
  if (it == kLeast.end() || voxels.empty()) return 0;
  const double over_m = LengthOf(voxels, voxel_m) - it->least_m;
  return std::clamp(0.5 - over_m / (2 * kUnsure_m), 0.0, 1.0);
}

}  // namespace crossnav::policy
