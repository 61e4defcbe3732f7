// SPDX-License-Identifier: MIT
// What one frame saw, collected in the blocks' frame masks, and how it becomes evidence
// (`map.clearing`). Occupied beats free within a frame. Internal to the map.
#pragma once

#include <array>

#include "crossnav/geometry/map_data.h"

namespace crossnav::geometry {

/// Sets bits of the current frame; remembers the last block, neighbours mostly share one, and some
/// before it, as noise goes to and fro between a few.
class FrameMarker {
 public:
  explicit FrameMarker(MapData& map) : map_(&map), is_clipped_(map.config.clip_to_extent) {}

  void MarkFree(const VoxelKey& key) {
    if (VoxelBlock* block = BlockOf(key)) block->frame_free.Set(CellIndexOf(key));
  }

  /// False if the key lies outside a clipped map.
  bool MarkHit(const VoxelKey& key) {
    VoxelBlock* block = BlockOf(key);
    if (block != nullptr) block->frame_hit.Set(CellIndexOf(key));
    return block != nullptr;
  }

 private:
  VoxelBlock* BlockOf(const VoxelKey& key) {
    if (block_ == nullptr || BlockKeyOf(key) != block_key_ || is_clipped_) Find(key);
    return block_;
  }
  void Find(const VoxelKey& key);

  struct Known {
    VoxelKey key;
    VoxelBlock* block = nullptr;
  };
  static constexpr std::size_t kKnown = 256;  // chosen: in the first cache
  Known& KnownOf(const VoxelKey& key) {
    const int slot = key.x + 7 * key.y + 31 * key.z;
    return known_[static_cast<std::size_t>(slot) % kKnown];
  }

  MapData* map_;
  VoxelBlock* block_ = nullptr;
  VoxelKey block_key_;
  bool is_clipped_ = false;
  std::array<Known, kKnown> known_{};
};

/// True if the map keeps `key` (always, unless map.clip_to_extent).
inline bool IsKept(const MapData& map, const VoxelKey& key) {
  if (!map.config.clip_to_extent) return true;
  const int xy = map.cells.extent_xy, z = map.cells.extent_z;
  return key.x >= -xy && key.x < xy && key.y >= -xy && key.y < xy && key.z >= -z && key.z < z;
}

/// Adds the entry to the frame's list of touched blocks.
void ListInFrame(MapData& map, GridEntry& entry);

/// Turns the frame masks into evidence, lists what changed, and empties them.
void MergeFrame(MapData& map);

/// True where more passes would leave the count as it is.
bool IsSettled(const HitCount& count, const MapConfig& config);

}  // namespace crossnav::geometry
