// SPDX-License-Identifier: MIT
// Dense arrays of a saved map for millions of lookups: content of each voxel, and proximity of the
// nearest surface. Map frame; lengths in voxels. Padded, so that a scan around any observed voxel
// stays inside. Read-only after construction.
#pragma once

#include <cstdint>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/voxel_key.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::localization {

enum class Content : std::uint8_t { kUnknown = 0, kFree = 1, kSurface = 2 };

struct DenseMap {
  double voxel_m = 0.1;
  geometry::VoxelKey lo;            ///< of the first voxel
  int nx = 0, ny = 0, nz = 0;       ///< [voxels], x fastest
  std::vector<Content> content;     ///< [nz x ny x nx]
  std::vector<std::uint8_t> score;  ///< 0 to 100: of a scan point in this voxel

  /// The index of a voxel, -1 outside.
  std::int64_t IndexOf(int x, int y, int z) const {
    const int i = x - lo.x, j = y - lo.y, k = z - lo.z;
    if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz) return -1;
    return (static_cast<std::int64_t>(k) * ny + j) * nx + i;
  }
  std::int64_t IndexOf(const geometry::VoxelKey& key) const { return IndexOf(key.x, key.y, key.z); }
  Content ContentAt(const geometry::VoxelKey& key) const {
    const std::int64_t index = IndexOf(key);
    return index < 0 ? Content::kUnknown : content[static_cast<std::size_t>(index)];
  }
};

/// `pad_xy_m` and `pad_z_m` around the map's box. Error: the map is empty, or has more than
/// kMaxVoxels.
Result<DenseMap> MakeDenseMap(const geometry::VoxelMap& map, double pad_xy_m, double pad_z_m);

inline constexpr std::int64_t kMaxVoxels = 400'000'000;  // chosen: 1 GB; 100 x 100 x 20 m and more

}  // namespace crossnav::localization
