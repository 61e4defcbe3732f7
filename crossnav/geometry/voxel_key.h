// SPDX-License-Identifier: MIT
// Voxel indices. A key is floor(p / voxel_m) per axis, any sign; it is an index, not a vector.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <functional>

#include "crossnav/core/pose.h"

namespace crossnav::geometry {

struct VoxelKey {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const VoxelKey&, const VoxelKey&) = default;  // NOLINT: takes 0 for null
  friend VoxelKey operator+(const VoxelKey& a, const VoxelKey& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend VoxelKey operator-(const VoxelKey& a, const VoxelKey& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

/// The voxel that holds `p_world`.
inline VoxelKey KeyOf(const Vector3d& p_world, double voxel_m) {
  return {static_cast<std::int32_t>(std::floor(p_world.x() / voxel_m)),
          static_cast<std::int32_t>(std::floor(p_world.y() / voxel_m)),
          static_cast<std::int32_t>(std::floor(p_world.z() / voxel_m))};
}

inline Vector3d CenterOf(const VoxelKey& key, double voxel_m) {
  return {(key.x + 0.5) * voxel_m, (key.y + 0.5) * voxel_m, (key.z + 0.5) * voxel_m};
}

inline Vector3d MinCornerOf(const VoxelKey& key, double voxel_m) {
  return {key.x * voxel_m, key.y * voxel_m, key.z * voxel_m};
}

/// Euclidean distance in voxels.
inline double VoxelDistance(const VoxelKey& a, const VoxelKey& b) {
  const double dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

struct VoxelKeyHash {
  std::size_t operator()(const VoxelKey& k) const {
    std::uint64_t h = static_cast<std::uint32_t>(k.x) * 0x9e3779b97f4a7c15ULL;
    h ^= static_cast<std::uint32_t>(k.y) * 0xc2b2ae3d27d4eb4fULL + (h >> 29);
    h ^= static_cast<std::uint32_t>(k.z) * 0x165667b19e3779f9ULL + (h << 17);
    h *= 0xd6e8feb86659fd93ULL;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

}  // namespace crossnav::geometry
