// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/map_error.h"

#include <algorithm>
#include <vector>

namespace crossnav::evaluation {
namespace {

constexpr double kReach_m = 0.5;      // chosen: larger errors count as this
constexpr std::size_t kMost = 4000;   // chosen: voxels; more do not change the mean
constexpr double kStrayVoxels = 1.5;  // chosen: half a voxel, plus one for the discretization

double DistanceToSurface(const Vector3d& p_world, const sim::RayCaster& caster) {
  double nearest_m = kReach_m;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vector3d direction = Vector3d(x, y, z).normalized();
        const auto hit = caster.Cast(p_world, direction, nearest_m);
        if (hit) nearest_m = std::min(nearest_m, hit->distance_m);
      }
  return nearest_m;
}

}  // namespace

MapError MeasureMapError(const geometry::VoxelMap& map, const sim::RayCaster& caster) {
  const double voxel_m = map.config().voxel_m;
  std::vector<geometry::VoxelKey> surfaces;
  map.ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel& voxel) {
    if (geometry::IsSurface(voxel.state)) surfaces.push_back(key);
  });
  MapError error;
  const std::size_t stride = 1 + surfaces.size() / kMost;
  for (std::size_t i = 0; i < surfaces.size(); i += stride) {
    const double off_m = DistanceToSurface(geometry::CenterOf(surfaces[i], voxel_m), caster);
    error.mean_m += off_m;
    error.stray_share += off_m > kStrayVoxels * voxel_m ? 1 : 0;
    ++error.voxels;
  }
  if (error.voxels > 0) {
    error.mean_m /= error.voxels;
    error.stray_share /= error.voxels;
  }
  return error;
}

}  // namespace crossnav::evaluation
