// SPDX-License-Identifier: MIT
// Lengths of objects beside the usual ones of a goal: smaller furniture of the same shape is taken
// for it, an armchair for a sofa. Metres.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::policy {

/// Longer side of the smallest upright box about all but the outermost voxels, turned about its
/// axis; 0 without any.
double LengthOf(const std::vector<geometry::VoxelKey>& voxels, double voxel_m);

/// How surely an object of the length is shorter than any of the goal's name [0, 1]; 0 for goals
/// that come in all lengths. `goal`: as CanonicalName gives it.
double ShortnessOf(std::string_view goal, double length_m);

}  // namespace crossnav::policy
