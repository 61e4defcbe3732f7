// SPDX-License-Identifier: MIT
#include "crossnav/geometry/map_blocks.h"

#include <string>

#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/map_data.h"

namespace crossnav::geometry {
namespace {

std::string NameOf(const VoxelKey& block) {
  return "block " + std::to_string(block.x) + "," + std::to_string(block.y) + "," +
         std::to_string(block.z);
}

}  // namespace

std::vector<MapBlock> ExportBlocks(const VoxelMap& map) {
  std::vector<MapBlock> blocks;
  for (const GridEntry& entry : MapAccess::Of(map).grid.entries()) {
    const VoxelBlock& from = entry.block;
    MapBlock to{entry.key,      from.hit,        from.free, from.agent_support,
                from.stair_low, from.stair_high, {}};
    if (from.counts) to.counts.assign(from.counts->begin(), from.counts->end());
    blocks.push_back(std::move(to));
  }
  return blocks;
}

void CountEvidence(const MapConfig& config, MapBlock* block) {
  if (!block->counts.empty()) return;
  const auto most = static_cast<std::uint16_t>(std::max(config.max_hits, config.min_hits));
  const auto old = static_cast<std::uint16_t>(std::min<int>(most, config.min_hits + 2));
  block->counts.resize(kBlockVoxels);
  for (int cell = 0; cell < kBlockVoxels; ++cell) {
    HitCount& count = block->counts[static_cast<std::size_t>(cell)];
    if (block->hit.Test(cell))
      count.hits = old;
    else if (block->free.Test(cell))
      count.passes = most;
  }
}

Result<VoxelMap> ImportBlocks(const std::vector<MapBlock>& blocks, const MapConfig& config) {
  VoxelMap map(config);
  MapData& data = MapAccess::Of(map);
  const bool is_counted = config.clearing == "evidence";
  for (const MapBlock& from : blocks) {
    if (data.grid.Find(from.key) != nullptr)
      return Fail(ErrorCode::kInvalid, "the block is there twice", NameOf(from.key));
    if (!from.counts.empty() && from.counts.size() != kBlockVoxels)
      return Fail(ErrorCode::kInvalid, "hit counts must be 512 or none", NameOf(from.key));
    if (!is_counted && (from.hit & from.free).Any())
      return Fail(ErrorCode::kInvalid, "a voxel is both hit and free", NameOf(from.key));
    GridEntry& entry = data.grid.TouchEntry(from.key);
    VoxelBlock& to = entry.block;
    to.hit = from.hit;
    to.free = from.free;
    to.agent_support = from.agent_support;
    to.stair_low = from.stair_low;
    to.stair_high = from.stair_high;
    if (is_counted && !from.counts.empty()) {
      to.counts = std::make_unique<HitCounts>();
      std::copy(from.counts.begin(), from.counts.end(), to.counts->begin());
      for (int cell = 0; cell < kBlockVoxels; ++cell)
        if (IsSettled(from.counts[cell], config) && !to.hit.Test(cell)) to.settled.Set(cell);
    }
    to.changed_surface = to.Surface();
    to.changed_free = to.free;
    ListChanged(data, entry);
  }
  map.UpdateStates();
  return map;
}

}  // namespace crossnav::geometry
