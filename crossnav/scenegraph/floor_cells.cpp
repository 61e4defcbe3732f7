// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/floor_cells.h"

#include <algorithm>

#include "crossnav/core/cells.h"

namespace crossnav::scenegraph {
namespace {

using geometry::VoxelMap;
using geometry::VoxelState;

// Heights above the ground.
constexpr double kBandFrom_m = 1.0, kBandTo_m = 1.8;  // chosen: above tables, below door heads
constexpr double kSupportFrom_m = -0.6, kSupportTo_m = 1.0;  // chosen: sunken floor to sideboard
// Below the ceiling: door heads end lower, lamps and tops of cupboards lie lower.
constexpr double kSlabFrom_m = 0.4, kSlabTo_m = 0.1;  // chosen
constexpr double kThin_m =
    0.4;  // chosen: a lintel is as thick as a wall, a sloping roof is thicker

struct Seen {
  int surfaces = 0, air = 0;
};

Seen Look(VoxelMap::Cursor& cursor, int x, int y, int z_from, int z_to) {
  Seen seen;
  for (int z = z_from; z < z_to; ++z) {
    const VoxelState state = cursor.At({x, y, z}).state;
    if (IsSurface(state)) ++seen.surfaces;
    if (!IsSurface(state) && state != VoxelState::kUnknown) ++seen.air;
  }
  return seen;
}

/// Voxel offsets of the heights above.
struct Offsets {
  int band_from, band_to, support_from, support_to, slab_from, slab_to;
};

FloorCell CellAt(VoxelMap::Cursor& cursor, int x, int y, int ground, const Offsets& at) {
  const Seen band = Look(cursor, x, y, ground + at.band_from, ground + at.band_to);
  const Seen support = Look(cursor, x, y, ground + at.support_from, ground + at.support_to);
  const int slab_from = std::max(at.slab_from, ground + at.band_to);
  const Seen slab = Look(cursor, x, y, slab_from, at.slab_to);
  const bool is_open = band.air > band.surfaces && band.air > 0;
  const bool is_open_above = slab.air > 0 && slab.surfaces == 0;
  if (is_open && support.surfaces == 0) return FloorCell::kOutside;
  if (is_open) return slab.surfaces > 0 && slab.air == 0 ? FloorCell::kLintel : FloorCell::kOpen;
  if (band.surfaces == 0) return FloorCell::kOutside;
  return is_open_above ? FloorCell::kOpen : FloorCell::kWall;
}

/// Opens lintels that contain a square of `square` cells: they are parts of a low ceiling.
void OpenWideLintels(PlanGrid<FloorCell>& plan, int square) {
  const PlanGrid<FloorCell> before = plan;
  const auto is_lintel = [&](int x, int y) { return before.At(x, y) == FloorCell::kLintel; };
  for (std::size_t i = 0; i < plan.cells.size(); ++i) {
    const int x = plan.frame.XOf(i), y = plan.frame.YOf(i);
    bool is_wide = is_lintel(x, y);
    for (int k = 0; is_wide && k < square * square; ++k)
      is_wide = is_lintel(x + k % square, y + k / square);
    for (int k = 0; is_wide && k < square * square; ++k)
      plan.cells[plan.frame.IndexOf(x + k % square, y + k / square)] = FloorCell::kOpen;
  }
}

}  // namespace

PlanGrid<FloorCell> FloorCellsOf(const VoxelMap& map, const Storey& storey) {
  const double voxel_m = map.config().voxel_m;
  const double top_m = storey.ceiling_m.value_or(0);
  Offsets at{CellsNearest(kBandFrom_m, voxel_m),         CellsNearest(kBandTo_m, voxel_m),
             CellsNearest(kSupportFrom_m, voxel_m),      CellsNearest(kSupportTo_m, voxel_m),
             CellsNearest(top_m - kSlabFrom_m, voxel_m), CellsNearest(top_m - kSlabTo_m, voxel_m)};
  if (!storey.ceiling_m) at.slab_to = at.slab_from = kNoGround;
  VoxelMap::Cursor cursor(map);
  PlanGrid<FloorCell> plan(storey.ground_z.frame, FloorCell::kOutside);
  for (std::size_t i = 0; i < plan.cells.size(); ++i) {
    const int ground = storey.ground_z.cells[i];
    if (ground == kNoGround) continue;
    plan.cells[i] = CellAt(cursor, plan.frame.XOf(i), plan.frame.YOf(i), ground, at);
  }
  OpenWideLintels(plan, CellsCeil(kThin_m, voxel_m) + 1);
  return plan;
}

}  // namespace crossnav::scenegraph
