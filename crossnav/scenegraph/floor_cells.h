// SPDX-License-Identifier: MIT
// The floor plan of a storey as cells, from the map alone.
#pragma once

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/scenegraph/storeys.h"

namespace crossnav::scenegraph {

enum class FloorCell : std::uint8_t {
  kOutside,  ///< no known voxel of this storey
  kOpen,     ///< air over ground or furniture
  kLintel,   ///< passable air, closed above: a doorway
  kWall,
};

/// One cell for each column of the storey's window. Furniture below the ceiling is not a wall.
PlanGrid<FloorCell> FloorCellsOf(const geometry::VoxelMap& map, const Storey& storey);

}  // namespace crossnav::scenegraph
