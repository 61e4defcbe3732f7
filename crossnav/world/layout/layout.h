// SPDX-License-Identifier: MIT
// Division of a house's levels into rectangles: a corridor with strips of cells on both sides,
// stair shafts at the same place on the levels that they join, and sometimes a room across the
// corridor's end. Canonical frame: the footprint is [0, width] x [0, depth], the corridor runs
// along x.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {

/// A stairwell through levels lo..hi; one stair per storey, all of one kind and size in plan.
struct Shaft {
  StairParams params;
  int lo = 0, hi = 1;
  bool is_north = true;      ///< side of the corridor
  bool is_enclosed = false;  ///< a separate room behind doors
  double x0 = 0, width_m = 0, depth_m = 0;
};

struct Cell {
  Rect rect;
  int parent = -1;  ///< cell that holds its door; -1 = the corridor
  bool is_end_room = false;
  bool is_void = false;  ///< open to the cell below
};

struct LevelLayout {
  Rect corridor;
  std::vector<Rect> more_corridors;  ///< of the same hall, in large buildings
  std::vector<Cell> cells;
};

struct HouseLayout {
  double width_m = 0, depth_m = 0;
  double corridor_y0 = 0, corridor_y1 = 0;
  std::vector<Shaft> shafts;
  std::vector<LevelLayout> levels;
};

struct LayoutParams {
  int edition = 1;
  bool is_office = false;
  int levels = 2;
  double area_m2 = 90;
  bool has_basement = false;
  bool has_attic = false;       ///< a separate stair leads to the top level
  std::vector<double> rises_m;  ///< floor to floor, one per storey
  double slab_m = 0.25;
};

/// nullopt if the draw fails (a shaft does not fit); try another seed.
std::optional<HouseLayout> DrawLayout(const LayoutParams& params, Rng& rng);

/// Rectangle of the shaft in the canonical frame.
Rect RectOf(const HouseLayout& layout, const Shaft& shaft);

/// Stair of the shaft from `level` to the next, in the canonical frame, at height `z_m`.
StairBlock StairIn(const HouseLayout& layout, const Shaft& shaft, int level, double rise_m);

}  // namespace crossnav::world
