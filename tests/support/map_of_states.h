// SPDX-License-Identifier: MIT
// Maps with states set by hand, for tests of code that reads a map. Evidence stays empty: do not
// update such a map.
#pragma once

#include <vector>

#include "crossnav/geometry/map_data.h"
#include "crossnav/geometry/sparse_grid.h"

namespace crossnav::test {

inline void SetState(geometry::VoxelMap& map, const geometry::VoxelKey& key,
                     geometry::VoxelState state, bool is_inflated = false) {
  auto& block = geometry::MapAccess::Of(map).grid.Touch(geometry::BlockKeyOf(key));
  block.cells[geometry::CellIndexOf(key)] =
      static_cast<std::uint8_t>(state) | (is_inflated ? geometry::kInflatedBit : 0);
}

/// Ground at height index `z` over [x0, x1) x [y0, y1), with four layers of standing air above it.
inline void AddGround(geometry::VoxelMap& map, int x0, int y0, int x1, int y1, int z) {
  for (int x = x0; x < x1; ++x)
    for (int y = y0; y < y1; ++y) {
      SetState(map, {x, y, z}, geometry::VoxelState::kOccupied);
      for (int k = 1; k <= 4; ++k) SetState(map, {x, y, z + k}, geometry::VoxelState::kTraversable);
      for (int k = 5; k <= 15; ++k)
        SetState(map, {x, y, z + k}, geometry::VoxelState::kTraversableFake);
    }
}

}  // namespace crossnav::test
