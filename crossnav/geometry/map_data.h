// SPDX-License-Identifier: MIT
// What a VoxelMap is made of, shared by the room's own source files. Internal.
#pragma once

#include <cstdint>
#include <vector>

#include "crossnav/geometry/depth_view.h"
#include "crossnav/geometry/end_rows.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry {

/// The configuration's lengths in voxels.
struct MapCells {
  int support_depth = 4;
  int max_climb = 3;
  int agent_height = 15;
  double inflation = 2;  ///< radius
  int extent_xy = 0;     ///< keys in [-extent, extent) where clipped; 0 = unbounded
  int extent_z = 0;
};

MapCells CellsOf(const MapConfig& config);

using Grid = SparseGrid<VoxelBlock>;
using GridEntry = Grid::Entry;

/// Two neighbouring pixels whose end voxels do not share a face: (u, v) and the one to the right of
/// it, or below it.
struct PixelGap {
  int u = 0, v = 0;
  bool is_column = false;
  bool is_wide = false;  ///< the voxels do not touch at all, or one is missing
  VoxelKey first, step;  ///< the end voxel of (u, v), and from it to the other's; where both are

  PixelGap(int pixel_u, int pixel_v, bool is_down) : u(pixel_u), v(pixel_v), is_column(is_down) {}
};

struct MapData {
  MapConfig config;
  MapCells cells;
  Grid grid;
  std::vector<GridEntry*> changed;         ///< blocks whose evidence changed since UpdateStates()
  std::vector<GridEntry*> frame;           ///< blocks the current frame touched
  std::vector<PixelGap> gaps;              ///< of the current frame, map.clearing = evidence
  std::vector<std::int32_t> apart_pixels;  ///< scratch
  RowEnds row_above;                       ///< scratch
  RowEnds row_ends;                        ///< scratch
  DepthView view;                          ///< of the current frame
  EndVoxels ends;                          ///< of the current frame
  std::vector<StateChange> changes;
  std::uint64_t revision = 0;
};

/// Puts `entry` on the list of changed blocks.
inline void ListChanged(MapData& map, GridEntry& entry) {
  if (entry.block.is_listed) return;
  entry.block.is_listed = true;
  map.changed.push_back(&entry);
}

/// The map's data, for the room's own files.
struct MapAccess {
  static MapData& Of(VoxelMap& map);
  static const MapData& Of(const VoxelMap& map);
};

}  // namespace crossnav::geometry
