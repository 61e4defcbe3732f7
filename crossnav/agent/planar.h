// SPDX-License-Identifier: MIT
// The planar baseline (variant `planar`): observations of any floor are stored on the start level,
// a row per column, as in a bird's-eye-view map.
#pragma once

#include <vector>

#include "crossnav/geometry/end_voxel_list.h"

namespace crossnav::agent {

/// The frame's end voxels with every key moved to half a metre above `level_m`.
std::vector<geometry::EndRun> CollapsedOn(double level_m, const geometry::EndVoxels& ends,
                                          double voxel_m);

}  // namespace crossnav::agent
