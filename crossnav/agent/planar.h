// SPDX-License-Identifier: MIT
// The planar baseline (variant `planar`): what is seen on any floor is remembered on the start
// level, one row a column, as a bird's-eye-view map would.
#pragma once

#include <vector>

#include "crossnav/geometry/end_voxel_list.h"

namespace crossnav::agent {

/// The frame's end voxels with every key moved to half a metre above `level_m`.
std::vector<geometry::EndRun> CollapsedOn(double level_m, const geometry::EndVoxels& ends,
                                          double voxel_m);

}  // namespace crossnav::agent
