// SPDX-License-Identifier: MIT
// Where an object may stand unnoticed: patches of ground and of furniture tops, and from how near
// each was looked at. Coverage knows the ground alone; a bowl stands on a desk. World frame,
// metres.
#pragma once

#include <limits>
#include <map>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::policy {

/// Least distances from which a point was looked at [m]; infinite = never.
struct Looked {
  float in_run_m = std::numeric_limits<float>::infinity();    ///< since the map was opened
  float for_goal_m = std::numeric_limits<float>::infinity();  ///< since the goal was set
};

/// Surface of about 0.4 x 0.4 m with air above.
struct SearchPatch {
  Vector3d p_world = Vector3d::Zero();  ///< the middle of the surface
  double height_m = 0;                  ///< above the level
  int columns = 0;                      ///< voxels of the surface
  Looked low;                           ///< at the air just above it
  Looked high;                          ///< where a chair or a lamp would reach

  static constexpr double kHighestTop_m = 1.5;  // chosen: higher tops are shelves under the ceiling
  static constexpr double kLow_m = 0.15, kHigh_m = 0.45;  // chosen: a vase, the back of a chair
  Vector3d LowPoint() const { return p_world + Vector3d(0, 0, kLow_m); }
  Vector3d HighPoint() const { return p_world + Vector3d(0, 0, kHigh_m); }
};

class SearchField {
 public:
  /// The patches at `level_m` in the columns `lo` to `hi` (x and y) as the map is now. Looks at
  /// patches are kept, also while the map does not show them. Of a top higher than the camera,
  /// which is `eye_m` above the level, an edge shows: it goes on under seen air.
  void Update(const geometry::VoxelMap& map, double level_m, double eye_m,
              const geometry::VoxelKey& lo, const geometry::VoxelKey& hi);

  /// Notes the distance of the points within `range_m` that this frame shows.
  void Look(const Observation& obs, double range_m);

  void BeginGoal();

  /// By coarse cell.
  const std::map<geometry::VoxelKey, SearchPatch>& patches() const { return patches_; }

 private:
  std::map<geometry::VoxelKey, SearchPatch> patches_;
  std::map<geometry::VoxelKey, SearchPatch> lost_;  // not in the map now; their looks still count
};

/// Voxels of the level surface that the patch of `cell` is a part of, in its 3 x 3 cells.
int ColumnsAround(const SearchField& field, const geometry::VoxelKey& cell);

}  // namespace crossnav::policy
