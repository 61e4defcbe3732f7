// SPDX-License-Identifier: MIT
// A straight flight between two floors as a map with real evidence: the lower floor for x < 0, the
// steps from x = 0 on, the upper floor behind them. World frame; y in [0, width_m].
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "crossnav/core/cells.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/geometry/sparse_grid.h"

namespace crossnav::test {

struct FlightSize {
  int steps = 12;
  double riser_m = 0.175;
  double tread_m = 0.28;
  double width_m = 1.0;
  double floor_m = 2.0;  ///< length of the floors before and after
};

struct FlightWorld {
  geometry::VoxelMap map;
  std::vector<geometry::VoxelKey> flight;  ///< treads and risers, sorted
  double top_m = 0;                        ///< height of the upper floor
  double end_m = 0;                        ///< x where it begins
};

/// A map whose evidence is `surface`, and free air where `free` has it.
inline geometry::VoxelMap MapOfEvidence(const std::set<geometry::VoxelKey>& surface,
                                        const std::set<geometry::VoxelKey>& free) {
  geometry::SparseGrid<geometry::MapBlock> grid;
  for (const auto& key : surface)
    grid.Touch(geometry::BlockKeyOf(key)).hit.Set(geometry::CellIndexOf(key));
  for (const auto& key : free)
    if (!surface.contains(key))
      grid.Touch(geometry::BlockKeyOf(key)).free.Set(geometry::CellIndexOf(key));
  std::vector<geometry::MapBlock> blocks;
  for (auto& entry : grid.entries()) {
    entry.block.key = entry.key;
    blocks.push_back(entry.block);
  }
  return std::move(*geometry::ImportBlocks(blocks, {}));
}

inline FlightWorld MakeFlight(const FlightSize& size = {}) {
  constexpr double kVoxel_m = 0.1;
  FlightWorld world;
  world.top_m = size.steps * size.riser_m;
  world.end_m = size.steps * size.tread_m;
  const auto height_at = [&](double x) {
    const int step = x < 0 ? 0 : static_cast<int>(std::floor(x / size.tread_m)) + 1;
    return std::min(step, size.steps) * size.riser_m;
  };
  const auto layer_of = [](double z_m) { return CellsCeil(z_m, kVoxel_m) - 1; };
  const int first = -CellsCeil(size.floor_m, kVoxel_m),
            last = CellsCeil(world.end_m + size.floor_m, kVoxel_m),
            width = CellsCeil(size.width_m, kVoxel_m);
  std::set<geometry::VoxelKey> surface, free, flight;
  for (int x = first; x < last; ++x) {
    const double center_m = (x + 0.5) * kVoxel_m;
    const int z = layer_of(height_at(center_m)), before = layer_of(height_at(center_m - kVoxel_m));
    for (int y = 0; y < width; ++y) {
      for (int k = std::min(before + 1, z); k <= z; ++k) {
        surface.insert({x, y, k});
        if (center_m > 0 && center_m < world.end_m) flight.insert({x, y, k});
      }
      for (int k = 1; k <= 18; ++k) free.insert({x, y, z + k});
    }
  }
  world.map = MapOfEvidence(surface, free);
  world.flight.assign(flight.begin(), flight.end());
  return world;
}

}  // namespace crossnav::test
