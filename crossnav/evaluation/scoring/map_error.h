// SPDX-License-Identifier: MIT
// Distance of a map's surfaces from the scene's: the effect of imperfect sensors on a map.
#pragma once

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/sim/render/ray_caster.h"

namespace crossnav::evaluation {

struct MapError {
  double mean_m = 0;  ///< from a surface voxel's centre to the next real surface, at most 0.5 m
  double stray_share = 0;  ///< share of surface voxels farther than 1.5 voxels from any surface
  int voxels = 0;          ///< measured voxels: all, or every n-th of many
};

/// Distance of surface voxels to the meshes, along 26 directions each. All zero for a map without
/// surfaces.
MapError MeasureMapError(const geometry::VoxelMap& map, const sim::RayCaster& caster);

}  // namespace crossnav::evaluation
