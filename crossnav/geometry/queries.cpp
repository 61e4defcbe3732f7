// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crossnav/core/cells.h"
#include "crossnav/geometry/map_data.h"
#include "crossnav/geometry/ray_walk.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry {

Voxel VoxelMap::At(const VoxelKey& key) const {
  const VoxelBlock* block = data_->grid.Find(BlockKeyOf(key));
  return block ? DecodeCell(block->cells[CellIndexOf(key)]) : Voxel{};
}

StairMark VoxelMap::StairMarkAt(const VoxelKey& key) const {
  const VoxelBlock* block = data_->grid.Find(BlockKeyOf(key));
  if (block == nullptr) return StairMark::kNone;
  const int cell = CellIndexOf(key);
  return static_cast<StairMark>(block->stair_low.Test(cell) | block->stair_high.Test(cell) << 1);
}

void VoxelMap::ForEach(const std::function<void(const VoxelKey&, const Voxel&)>& visit) const {
  for (const GridEntry& entry : data_->grid.entries())
    for (int cell = 0; cell < kBlockVoxels; ++cell)
      if (entry.block.cells[cell] != 0)
        visit(KeyInBlock(entry.key, cell), DecodeCell(entry.block.cells[cell]));
}

void VoxelMap::ForEachInBox(const VoxelKey& lo, const VoxelKey& hi,
                            const std::function<void(const VoxelKey&, const Voxel&)>& visit) const {
  GridReader<VoxelBlock> reader(data_->grid);
  for (int z = lo.z; z <= hi.z; ++z) {
    for (int y = lo.y; y <= hi.y; ++y) {
      for (int x = lo.x; x <= hi.x;) {
        const int row_end = std::min(hi.x, x | (kBlockSide - 1));
        const VoxelBlock* block = reader.Find({x, y, z});
        if (block == nullptr) {
          x = row_end + 1;
          continue;
        }
        for (; x <= row_end; ++x) {
          const std::uint8_t cell = block->cells[CellIndexOf({x, y, z})];
          if (cell != 0) visit({x, y, z}, DecodeCell(cell));
        }
      }
    }
  }
}

void VoxelMap::ForEachInSlab(
    int z_lo, int z_hi, const std::function<void(const VoxelKey&, const Voxel&)>& visit) const {
  for (const auto& [block_key, block] : data_->grid.entries()) {
    const int z_base = block_key.z * kBlockSide;
    const int first = std::max(z_lo - z_base, 0), last = std::min(z_hi - z_base, kBlockSide - 1);
    for (int cell = first * kBlockSide * kBlockSide; cell < (last + 1) * kBlockSide * kBlockSide;
         ++cell) {
      if (block.cells[cell] != 0) visit(KeyInBlock(block_key, cell), DecodeCell(block.cells[cell]));
    }
  }
}

bool VoxelMap::FindSupport(const VoxelKey& key, VoxelKey* support) const {
  Cursor cursor(*this);
  for (int k = 1; k <= data_->cells.support_depth; ++k) {
    const VoxelKey below{key.x, key.y, key.z - k};
    if (!IsSurface(cursor.At(below).state)) continue;
    *support = below;
    return true;
  }
  return false;
}

bool VoxelMap::NearestFree(const Vector3d& p_world, double radius_m, VoxelKey* found) const {
  const double voxel_m = data_->config.voxel_m;
  const VoxelKey center = KeyOf(p_world, voxel_m);
  const int r = CellsCeil(radius_m, voxel_m);
  double best_m = radius_m;
  bool is_found = false;
  ForEachInBox(center - VoxelKey{r, r, r}, center + VoxelKey{r, r, r},
               [&](const VoxelKey& key, const Voxel& voxel) {
                 const StateFacts& facts = FactsOf(voxel.state);
                 if (!facts.is_pathable || !facts.is_targetable || voxel.is_inflated) return;
                 const double distance_m = (CenterOf(key, voxel_m) - p_world).norm();
                 if (distance_m > best_m) return;
                 if (is_found && distance_m == best_m && !(key < *found)) return;
                 best_m = distance_m;
                 *found = key;
                 is_found = true;
               });
  return is_found;
}

bool VoxelMap::HasLineOfSight(const Vector3d& a_world, const Vector3d& b_world) const {
  const double voxel_m = data_->config.voxel_m;
  const VoxelKey start = KeyOf(a_world, voxel_m), end = KeyOf(b_world, voxel_m);
  bool is_clear = true;
  Cursor cursor(*this);
  WalkRay(a_world / voxel_m, b_world / voxel_m, [&](const VoxelKey& key) {
    is_clear = key == start || key == end || !IsSurface(cursor.At(key).state);
    return is_clear;
  });
  return is_clear;
}

bool VoxelMap::IsSeenThrough(const Vector3d& a_world, const Vector3d& b_world,
                             int most_unseen) const {
  const double voxel_m = data_->config.voxel_m;
  const VoxelKey start = KeyOf(a_world, voxel_m), end = KeyOf(b_world, voxel_m);
  bool is_clear = true;
  int unseen = 0;
  Cursor cursor(*this);
  WalkRay(a_world / voxel_m, b_world / voxel_m, [&](const VoxelKey& key) {
    if (key == start || key == end) return true;
    const VoxelState state = cursor.At(key).state;
    unseen += state == VoxelState::kUnknown ? 1 : 0;
    is_clear = !IsSurface(state) && unseen <= most_unseen;
    return is_clear;
  });
  return is_clear;
}

MapStats VoxelMap::Stats() const {
  MapStats stats;
  for (const GridEntry& entry : data_->grid.entries()) {
    for (const std::uint8_t cell : entry.block.cells) {
      const VoxelState state = DecodeCell(cell).state;
      stats.known += state != VoxelState::kUnknown;
      stats.occupied += IsSurface(state);
      stats.traversable += state == VoxelState::kTraversable;
    }
    if (entry.block.counts) stats.bytes += sizeof(HitCounts);
  }
  stats.blocks = static_cast<std::int64_t>(data_->grid.size());
  stats.bytes += static_cast<std::int64_t>(data_->grid.Bytes() + data_->ends.Bytes() +
                                           data_->changes.capacity() * sizeof(StateChange));
  return stats;
}

}  // namespace crossnav::geometry
