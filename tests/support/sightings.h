// SPDX-License-Identifier: MIT
// Sightings set by hand, for tests of code that reads detections in 3D.
#pragma once

#include <utility>
#include <vector>

#include "crossnav/policy/clusters.h"
#include "crossnav/policy/live_poi.h"

namespace crossnav::test {

/// Sighting of an object in voxels of 0.1 m.
inline policy::Sighting SightingOf(std::vector<geometry::VoxelKey> voxels, double confidence = 0.9,
                                   double area_fraction = 0.1) {
  policy::Sighting sighting;
  sighting.p_center_world = policy::CentroidOf(voxels, 0.1);
  sighting.voxels = std::move(voxels);
  sighting.confidence = confidence;
  sighting.mask_quality = 0.9;
  sighting.area_fraction = area_fraction;
  return sighting;
}

/// A wall of 4 x 4 voxels on the ground, along x from `at`.
inline policy::Sighting SightingOfWall(const geometry::VoxelKey& at) {
  std::vector<geometry::VoxelKey> voxels;
  for (int x = 0; x < 4; ++x)
    for (int z = 0; z < 4; ++z) voxels.push_back(at + geometry::VoxelKey{x, 0, z});
  return SightingOf(std::move(voxels));
}

}  // namespace crossnav::test
