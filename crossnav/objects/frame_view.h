// SPDX-License-Identifier: MIT
// View of remembered voxels in one depth image: seen free, at a surface, or hidden. World frame,
// metres.
#pragma once

#include <span>

#include "crossnav/core/observation.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::objects {

/// Shares of the sampled voxels [0, 1]; the remainder lies outside the picture or has no depth.
struct FrameView {
  double free = 0;        ///< the ray goes through the voxel and on
  double surface = 0;     ///< the ray ends at the voxel
  double hidden = 0;      ///< the ray ends before it
  double distance_m = 0;  ///< of the nearest sampled voxel in the picture
  double pixels = 0;      ///< estimate of the pixels that the voxels' box fills

  double Visible() const { return free + surface; }
};

/// Samples up to `samples` of `voxels` evenly. Cost O(samples).
FrameView ViewOf(std::span<const geometry::VoxelKey> voxels, const Observation& obs, double voxel_m,
                 int samples = 64);

}  // namespace crossnav::objects
