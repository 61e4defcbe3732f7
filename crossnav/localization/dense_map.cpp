// SPDX-License-Identifier: MIT
#include "crossnav/localization/dense_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "crossnav/core/cells.h"

namespace crossnav::localization {
namespace {

using geometry::VoxelKey;

constexpr double kKernel_m = 0.4;      // chosen: half a step of the search, and the map's voxels
constexpr std::uint8_t kUnknown = 25;  // chosen: unobserved space neither confirms nor contradicts

struct Bounds {
  VoxelKey lo{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(),
              std::numeric_limits<int>::max()};
  VoxelKey hi{std::numeric_limits<int>::min(), std::numeric_limits<int>::min(),
              std::numeric_limits<int>::min()};
};

Bounds BoundsOf(const geometry::VoxelMap& map) {
  Bounds b;
  map.ForEach([&](const VoxelKey& key, const geometry::Voxel&) {
    b.lo = {std::min(b.lo.x, key.x), std::min(b.lo.y, key.y), std::min(b.lo.z, key.z)};
    b.hi = {std::max(b.hi.x, key.x), std::max(b.hi.y, key.y), std::max(b.hi.z, key.z)};
  });
  return b;
}

struct KernelCell {
  std::int64_t offset;
  std::uint8_t score;
};

/// Score by the distance to a surface: 100 on it, linearly to 0 at kKernel_m.
std::vector<KernelCell> KernelOf(const DenseMap& dense) {
  const int reach = CellsCeil(kKernel_m, dense.voxel_m);
  std::vector<KernelCell> kernel;
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const double away_m = dense.voxel_m * std::sqrt(x * x + y * y + z * z);
        const double score = 100 * (1 - away_m / kKernel_m);
        if (score < 1) continue;
        kernel.push_back({(static_cast<std::int64_t>(z) * dense.ny + y) * dense.nx + x,
                          static_cast<std::uint8_t>(std::lround(score))});
      }
  return kernel;
}

void FillScores(DenseMap& dense) {
  const std::vector<KernelCell> kernel = KernelOf(dense);
  const std::size_t size = dense.content.size();
  dense.score.resize(size);
  for (std::size_t i = 0; i < size; ++i)
    dense.score[i] = dense.content[i] == Content::kUnknown ? kUnknown : 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (dense.content[i] != Content::kSurface) continue;
    for (const KernelCell& cell : kernel) {
      std::uint8_t& score = dense.score[i + static_cast<std::size_t>(cell.offset)];
      score = std::max(score, cell.score);
    }
  }
}

}  // namespace

Result<DenseMap> MakeDenseMap(const geometry::VoxelMap& map, double pad_xy_m, double pad_z_m) {
  DenseMap dense;
  dense.voxel_m = map.config().voxel_m;
  const Bounds b = BoundsOf(map);
  if (b.lo.x > b.hi.x) return Fail(ErrorCode::kInvalid, "the map is empty", "map");
  const int xy = CellsCeil(std::max(pad_xy_m, kKernel_m), dense.voxel_m) + 1;
  const int z = CellsCeil(std::max(pad_z_m, kKernel_m), dense.voxel_m) + 1;
  dense.lo = b.lo - VoxelKey{xy, xy, z};
  const std::int64_t nx = b.hi.x - b.lo.x + 1LL + 2 * xy, ny = b.hi.y - b.lo.y + 1LL + 2 * xy;
  const std::int64_t nz = b.hi.z - b.lo.z + 1LL + 2 * z;
  if (nx > kMaxVoxels / ny || nx * ny > kMaxVoxels / nz)
    return Fail(ErrorCode::kInvalid, "the map's box is too large to localise in", "map");
  dense.nx = static_cast<int>(nx), dense.ny = static_cast<int>(ny), dense.nz = static_cast<int>(nz);
  dense.content.assign(static_cast<std::size_t>(nx * ny * nz), Content::kUnknown);
  map.ForEach([&](const VoxelKey& key, const geometry::Voxel& voxel) {
    if (voxel.state == geometry::VoxelState::kUnknown) return;
    dense.content[static_cast<std::size_t>(dense.IndexOf(key))] =
        geometry::IsSurface(voxel.state) ? Content::kSurface : Content::kFree;
  });
  FillScores(dense);
  return dense;
}

}  // namespace crossnav::localization
