// SPDX-License-Identifier: MIT
// Queries of frontiers, stairs and the planner on a map, besides VoxelMap's own: heights and
// exploration levels, columns, neighbours. Nothing is cached; the map must not change meanwhile.
// World frame, metres.
#pragma once

#include <cmath>
#include <optional>

#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry {

/// A storey being explored, by the height of its floor.
struct ExplorationLevel {
  double height_m = 0;
  double tolerance_m = 0.35;  // chosen: method.md, "Candidates"
};

/// Height of the top of the surface that carries `key`: its support for air, itself for a surface.
/// Nothing where there is none. Cost O(support depth).
inline std::optional<double> StandingHeight(const VoxelMap& map, const VoxelKey& key) {
  const double voxel_m = map.config().voxel_m;
  const VoxelState state = map.StateAt(key);
  if (IsSurface(state)) return (key.z + 1) * voxel_m;
  VoxelKey support;
  if (state == VoxelState::kUnknown || !map.FindSupport(key, &support)) return std::nullopt;
  return (support.z + 1) * voxel_m;
}

/// True if the support of `key` belongs to `level`. Cost O(support depth).
inline bool IsOnLevel(const VoxelMap& map, const VoxelKey& key, const ExplorationLevel& level) {
  const std::optional<double> height_m = StandingHeight(map, key);
  return height_m.has_value() && std::abs(*height_m - level.height_m) <= level.tolerance_m;
}

/// True if anything is known within `reach_vox` above or below `key`, itself included. Cost
/// O(reach).
inline bool IsColumnObserved(const VoxelMap& map, const VoxelKey& key, int reach_vox) {
  VoxelMap::Cursor cursor(map);
  for (int dz = -reach_vox; dz <= reach_vox; ++dz)
    if (cursor.At({key.x, key.y, key.z + dz}).state != VoxelState::kUnknown) return true;
  return false;
}

/// Calls visit(key, voxel) for the 26 voxels around `key`, unknown ones too, x fastest.
template <class F>
void ForEachNeighbour26(const VoxelMap& map, const VoxelKey& key, F&& visit) {
  VoxelMap::Cursor cursor(map);
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0 && dz == 0) continue;
        const VoxelKey at{key.x + dx, key.y + dy, key.z + dz};
        visit(at, cursor.At(at));
      }
}

}  // namespace crossnav::geometry
