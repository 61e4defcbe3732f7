// SPDX-License-Identifier: MIT
// Observations of one frame, collected in the blocks' frame masks, and their conversion to evidence
// (`map.clearing`). Occupied beats free within a frame. Internal to the map.
#pragma once

#include "crossnav/geometry/map_data.h"

namespace crossnav::geometry {

/// True if the map keeps `key` (always, unless map.clip_to_extent).
inline bool IsKept(const MapData& map, const VoxelKey& key) {
  if (!map.config.clip_to_extent || !map.center) return true;
  const int xy = map.cells.extent_xy, z = map.cells.extent_z;
  const VoxelKey d = key - *map.center;
  return d.x >= -xy && d.x < xy && d.y >= -xy && d.y < xy && d.z >= -z && d.z < z;
}

/// Adds the entry to the frame's list of touched blocks.
void ListInFrame(MapData& map, GridEntry& entry);

/// Sets bits of the current frame.
class FrameMarker {
 public:
  explicit FrameMarker(MapData& map) : map_(&map), is_clipped_(map.config.clip_to_extent) {}

  void MarkFree(const VoxelKey& key) {
    if (IsMarked(key)) BlockOf(key).frame_free.Set(CellIndexOf(key));
  }

  /// False if the key lies outside a clipped map.
  bool MarkHit(const VoxelKey& key) {
    if (!IsMarked(key)) return false;
    BlockOf(key).frame_hit.Set(CellIndexOf(key));
    return true;
  }

 private:
  bool IsMarked(const VoxelKey& key) const { return !is_clipped_ || IsKept(*map_, key); }

  VoxelBlock& BlockOf(const VoxelKey& key) {
    return blocks_.Of(key, [this](const VoxelKey& block_key) -> VoxelBlock& {
      GridEntry& entry = map_->grid.TouchEntry(block_key);
      ListInFrame(*map_, entry);
      return entry.block;
    });
  }

  MapData* map_;
  bool is_clipped_ = false;
  KnownBlocks<VoxelBlock> blocks_;
};

/// Turns the frame masks into evidence, lists the changes, and empties the masks.
void MergeFrame(MapData& map);

/// True if further passes would not change the count.
bool IsSettled(const HitCount& count, const MapConfig& config);

}  // namespace crossnav::geometry
