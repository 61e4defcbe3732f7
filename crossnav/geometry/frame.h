// SPDX-License-Identifier: MIT
// What one frame saw, collected in the blocks' frame masks, and how it becomes evidence
// (`map.clearing`). Occupied beats free within a frame. Internal to the map.
#pragma once

#include <array>

#include "crossnav/geometry/map_data.h"

namespace crossnav::geometry {

/// True if the map keeps `key` (always, unless map.clip_to_extent).
inline bool IsKept(const MapData& map, const VoxelKey& key) {
  if (!map.config.clip_to_extent) return true;
  const int xy = map.cells.extent_xy, z = map.cells.extent_z;
  return key.x >= -xy && key.x < xy && key.y >= -xy && key.y < xy && key.z >= -z && key.z < z;
}

/// Sets bits of the current frame; remembers blocks, as neighbours share one and noise goes to and
/// fro between a few.
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
  struct Known {
    VoxelKey key;
    VoxelBlock* block = nullptr;
  };

  // Axis by axis, and all compared at once: which axis differs cannot be foreseen.
  VoxelBlock* BlockOf(const VoxelKey& key) {
    if (is_clipped_ && !IsKept(*map_, key)) return nullptr;
    const std::int32_t x = key.x >> kBlockBits, y = key.y >> kBlockBits, z = key.z >> kBlockBits;
    Known& known = known_[static_cast<std::uint32_t>(x + 7 * y + 31 * z) % kKnown];
    const bool is_other = ((known.key.x ^ x) | (known.key.y ^ y) | (known.key.z ^ z)) != 0;
    if (is_other || known.block == nullptr) Find({x, y, z}, &known);
    return known.block;
  }
  void Find(const VoxelKey& block_key, Known* known);

  static constexpr std::size_t kKnown = 256;  // chosen: in the first cache
  MapData* map_;
  bool is_clipped_ = false;
  std::array<Known, kKnown> known_{};
};

/// Adds the entry to the frame's list of touched blocks.
void ListInFrame(MapData& map, GridEntry& entry);

/// Turns the frame masks into evidence, lists what changed, and empties them.
void MergeFrame(MapData& map);

/// True where more passes would leave the count as it is.
bool IsSettled(const HitCount& count, const MapConfig& config);

}  // namespace crossnav::geometry
