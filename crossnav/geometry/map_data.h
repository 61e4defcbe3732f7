// SPDX-License-Identifier: MIT
// Parts of a VoxelMap, shared by the room's own source files. Internal.
#pragma once

#include <cstdint>
#include <optional>
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
  int extent_xy = 0;     ///< keys less the centre in [-extent, extent) where clipped
  int extent_z = 0;
};

MapCells CellsOf(const MapConfig& config);

using Grid = SparseGrid<VoxelBlock>;
using GridEntry = Grid::Entry;

struct MapData {
  MapConfig config;
  MapCells cells;
  Grid grid;
  std::vector<GridEntry*> changed;  ///< blocks with evidence changed since UpdateStates()
  std::vector<GridEntry*> frame;    ///< blocks the current frame touched
  RowEnds row_ends;                 ///< scratch
  DepthView view;                   ///< of the current frame
  EndVoxels ends;                   ///< of the current frame
  std::optional<VoxelKey> center;   ///< of a clipped map: the first camera's voxel
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
