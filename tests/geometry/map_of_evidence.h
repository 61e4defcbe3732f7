// SPDX-License-Identifier: MIT
// Micro-worlds: a map made from sets of voxels.
#pragma once

#include <utility>

#include "crossnav/geometry/map_blocks.h"
#include "tests/geometry/reference_map.h"

namespace crossnav::geometry::testing {

/// A map whose evidence is `surface` and `free`.
inline VoxelMap MapOfEvidence(const std::map<VoxelKey, StairMark>& surface, const KeySet& free,
                              const MapConfig& config = {}) {
  SparseGrid<MapBlock> grid;
  for (const auto& [key, mark] : surface) {
    MapBlock& block = grid.Touch(BlockKeyOf(key));
    block.hit.Set(CellIndexOf(key));
    if (static_cast<int>(mark) & 1) block.stair_low.Set(CellIndexOf(key));
    if (static_cast<int>(mark) & 2) block.stair_high.Set(CellIndexOf(key));
  }
  for (const VoxelKey& key : free)
    if (surface.count(key) == 0) grid.Touch(BlockKeyOf(key)).free.Set(CellIndexOf(key));
  std::vector<MapBlock> blocks;
  for (auto& entry : grid.entries()) {
    entry.block.key = entry.key;
    blocks.push_back(entry.block);
  }
  return std::move(*ImportBlocks(blocks, config));
}

}  // namespace crossnav::geometry::testing
