// SPDX-License-Identifier: MIT
#include "crossnav/agent/planar.h"

#include "crossnav/core/cells.h"

namespace crossnav::agent {

std::vector<geometry::EndRun> CollapsedOn(double level_m, const geometry::EndVoxels& ends,
                                          double voxel_m) {
  constexpr double kAbove_m = 0.5;  // chosen: where furniture is seen from beside it
  const int z = CellsFloor(level_m + kAbove_m, voxel_m);
  std::vector<geometry::EndRun> collapsed = ends.runs();
  for (geometry::EndRun& run : collapsed) run.key.z = z;
  return collapsed;
}

}  // namespace crossnav::agent
