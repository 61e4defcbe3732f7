// SPDX-License-Identifier: MIT
// The evidence of a whole map as plain blocks, to save and restore it without loss. States are not
// in it: they are derived again and come out equal (UpdateStates equals a full rebuild).
#pragma once

#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/voxel_block.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry {

/// Evidence of 8x8x8 voxels. Cell order as in sparse_grid.h: x fastest, z slowest.
struct MapBlock {
  VoxelKey key;  ///< in block units
  BlockMask hit;
  BlockMask free;
  BlockMask agent_support;
  BlockMask stair_low, stair_high;  ///< bits 0 and 1 of the StairMark of each voxel
  std::vector<HitCount> counts;     ///< 512, or none under `clearing = never`
  friend bool operator==(const MapBlock&, const MapBlock&) = default;
};

/// All blocks, in order of first observation. Cost O(blocks).
std::vector<MapBlock> ExportBlocks(const VoxelMap& map);

/// Counts of a block that has none, of `clearing = never`: three frames that look through a surface
/// remove it. Fewer would make holes in walls and treads, whose voxels are filled in part.
void CountEvidence(const MapConfig& config, MapBlock* block);

/// A map with this evidence and its states up to date. `where` of an error names the block.
Result<VoxelMap> ImportBlocks(const std::vector<MapBlock>& blocks, const MapConfig& config);

}  // namespace crossnav::geometry
