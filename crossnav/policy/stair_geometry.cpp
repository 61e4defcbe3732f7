// SPDX-License-Identifier: MIT
#include "crossnav/policy/stair_geometry.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "crossnav/core/cells.h"
#include "crossnav/policy/clusters.h"

namespace crossnav::policy {
namespace {

constexpr double kNeighbourhood_m = 1.0;
constexpr double kFullRise_m = 0.35;  // chosen: a 20 degree flight rises this much in one metre
constexpr double kFlatSlope = 0.21;   // chosen: 12 degrees, half of the gentlest flight
constexpr double kResidualGood_m = 0.10, kResidualBad_m = 0.25;  // chosen: one riser, and beyond it

std::vector<VoxelKey> Near(const std::vector<VoxelKey>& keys, const VoxelKey& center,
                           double radius_vox) {
  std::vector<VoxelKey> near;
  for (const VoxelKey& key : keys) {
    const double dx = key.x - center.x, dy = key.y - center.y;
    if (dx * dx + dy * dy <= radius_vox * radius_vox &&
        std::abs(key.z - center.z) <= 1.5 * radius_vox)
      near.push_back(key);
  }
  return near;
}

double Ramp(double value, double zero_at, double one_at) {
  return std::clamp((value - zero_at) / (one_at - zero_at), 0.0, 1.0);
}

double SlopeScore(double slope) {
  const double deg = RadToDeg(std::atan(slope));
  if (deg < 20) return Ramp(deg, 8, 20);
  return deg > 50 ? Ramp(deg, 65, 50) : 1.0;
}

double HeadRoom(const VoxelMap& map, const std::vector<VoxelKey>& tops) {
  const int height = CellsFloor(map.config().agent_height_m, map.config().voxel_m);
  VoxelMap::Cursor cursor(map);
  int free = 0;
  for (const VoxelKey& key : tops) {
    bool is_free = true;
    // The next riser may stand right behind a tread's edge: start one climb up.
    for (int dz = 3; dz <= height && is_free; ++dz)
      is_free = !IsSurface(cursor.At({key.x, key.y, key.z + dz}).state);
    free += is_free;
  }
  return tops.empty() ? 0 : static_cast<double>(free) / static_cast<double>(tops.size());
}

}  // namespace

std::vector<VoxelKey> ColumnTops(const std::vector<VoxelKey>& sorted) {
  std::vector<VoxelKey> tops;
  for (const VoxelKey& key : sorted) {
    if (!tops.empty() && tops.back().x == key.x && tops.back().y == key.y)
      tops.back() = key;
    else
      tops.push_back(key);
  }
  return tops;
}

PlaneFit FitPlane(const std::vector<VoxelKey>& voxels, double voxel_m) {
  PlaneFit fit;
  fit.count = static_cast<int>(voxels.size());
  if (fit.count < 3) return fit;
  const Vector3d mean = CentroidOf(voxels, voxel_m);
  Eigen::Matrix2d A = Eigen::Matrix2d::Identity() * 1e-9;
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const VoxelKey& key : voxels) {
    const Vector3d d = geometry::CenterOf(key, voxel_m) - mean;
    A += d.head<2>() * d.head<2>().transpose();
    b += d.head<2>() * d.z();
  }
  fit.gradient = A.ldlt().solve(b);
  double sum = 0;
  for (const VoxelKey& key : voxels) {
    const Vector3d d = geometry::CenterOf(key, voxel_m) - mean;
    const double r = d.z() - fit.gradient.dot(d.head<2>());
    sum += r * r;
  }
  fit.residual_m = std::sqrt(sum / fit.count);
  return fit;
}

StairGeometry ScoreStairGeometry(const VoxelMap& map, const std::vector<VoxelKey>& voxels) {
  StairGeometry score;
  if (voxels.size() < 6) return score;
  const double voxel_m = map.config().voxel_m;
  const auto tops = ColumnTops(voxels);
  const std::size_t samples = std::min<std::size_t>(tops.size(), 16);
  for (std::size_t i = 0; i < samples; ++i) {
    const auto near = Near(tops, tops[i * tops.size() / samples], kNeighbourhood_m / voxel_m);
    const auto [low, high] = std::minmax_element(
        near.begin(), near.end(), [](const VoxelKey& a, const VoxelKey& b) { return a.z < b.z; });
    score.height_variation += Ramp((high->z - low->z) * voxel_m, 0, kFullRise_m);
    const PlaneFit fit = FitPlane(near, voxel_m);
    score.step_trend +=
        SlopeScore(fit.gradient.norm()) * Ramp(fit.residual_m, kResidualBad_m, kResidualGood_m);
  }
  score.height_variation /= static_cast<double>(samples);
  score.step_trend /= static_cast<double>(samples);
  std::size_t largest = 0;
  for (const auto& part : ConnectedClusters(voxels, 2)) largest = std::max(largest, part.size());
  score.continuity = static_cast<double>(largest) / static_cast<double>(voxels.size());
  score.head_room = HeadRoom(map, tops);
  return score;
}

std::vector<VoxelKey> SupportsAround(const VoxelMap& map, const Vector3d& p_world_foot,
                                     double radius_m) {
  const double voxel_m = map.config().voxel_m;
  const VoxelKey foot = geometry::KeyOf(p_world_foot + Vector3d(0, 0, voxel_m / 2), voxel_m);
  const int reach = CellsFloor(radius_m, voxel_m),
            climb = CellsCeil(map.config().support_depth_m, voxel_m);
  std::vector<VoxelKey> supports;
  VoxelMap::Cursor cursor(map);
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy) {
      if (dx * dx + dy * dy > reach * reach) continue;
      for (int dz = climb; dz >= -climb; --dz) {
        const VoxelKey key{foot.x + dx, foot.y + dy, foot.z + dz};
        if (!IsSurface(cursor.At(key).state)) continue;
        // A wall fills the column up to the top of the search: not a support.
        if (dz < climb) supports.push_back(key);
        break;
      }
    }
  return supports;
}

bool IsFlatAround(const VoxelMap& map, const Vector3d& p_world_foot) {
  const auto supports = SupportsAround(map, p_world_foot, 0.5);
  if (supports.size() < 20) return false;  // chosen: a quarter of the disc
  return FitPlane(supports, map.config().voxel_m).gradient.norm() < kFlatSlope;
}

}  // namespace crossnav::policy
