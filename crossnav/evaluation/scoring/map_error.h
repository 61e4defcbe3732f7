// SPDX-License-Identifier: MIT
// How far a map's surfaces are from the scene's: what imperfect sensors do to a map.
#pragma once

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/sim/render/ray_caster.h"

namespace crossnav::evaluation {

struct MapError {
  double mean_m = 0;  ///< from a surface voxel's centre to the next real surface, 0.5 m at most
  double stray_share = 0;  ///< of the surface voxels farther than 1.5 voxels from any
  int voxels = 0;          ///< that were measured: all, or every n-th of many
};

/// Surface voxels against the meshes, along 26 directions each. All zero for a map without
/// surfaces.
MapError MeasureMapError(const geometry::VoxelMap& map, const sim::RayCaster& caster);

}  // namespace crossnav::evaluation
