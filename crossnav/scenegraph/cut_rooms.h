// SPDX-License-Identifier: MIT
// Rooms of a floor plan: open cells cut where they are closed above, and at narrow places (a
// watershed of the distance to walls; basins that meet in a wide place are one room).
#pragma once

#include "crossnav/scenegraph/floor_cells.h"

namespace crossnav::scenegraph {

inline constexpr int kNoRoom = -1;

struct RoomCutConfig {
  double passage_m = 1.4;    // chosen: wider openings join rooms; doors and archways are narrower
  double share = 0.5;        // chosen: of the smaller basin's widest place; seeds 1 to 3
  double min_area_m2 = 1.0;  // chosen: smaller pieces join a neighbour, or are removed
};

/// Room of each cell, from 0 by the first cell in row order, or kNoRoom. Doorways belong to the
/// nearest room.
PlanGrid<int> CutRooms(const PlanGrid<FloorCell>& plan, double cell_m,
                       const RoomCutConfig& config = {});

/// Distance from each open cell's centre to the border of the nearest cell that is not open
/// [cells].
PlanGrid<float> WallDistance(const PlanGrid<FloorCell>& plan);

}  // namespace crossnav::scenegraph
