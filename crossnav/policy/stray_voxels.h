// SPDX-License-Identifier: MIT
// Voxels that were taken for a part of an object and are none: masks from afar reach over its edge
// (over the rug or a table before a sofa), and later frames show that place beside the object.
// World frame.
#pragma once

#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::policy {

struct Sighting;

/// For each voxel of an object, how surely it is a part of it: frames that show it inside the mask
/// less frames that show it beside the object, nearer frames more. As long as the voxels.
using VoxelVotes = std::vector<float>;

/// The voxels of an object but for those that the frame of `sighting` shows beside it. Nothing in
/// the depth image hides such a voxel, and no voxel of the sighting touches it.
std::vector<geometry::VoxelKey> WithoutStrays(const std::vector<geometry::VoxelKey>& voxels,
                                              const Sighting& sighting, const Observation& obs,
                                              double voxel_m);

/// Adds the vote of a frame with `sighting` of the object to `votes` of its `voxels`, and removes
/// from both what is rather no part of it. Something always remains.
/// `voxels` are sorted.
void VoteOnVoxels(const Sighting& sighting, const Observation& obs, double voxel_m,
                  std::vector<geometry::VoxelKey>* voxels, VoxelVotes* votes);

}  // namespace crossnav::policy
