// SPDX-License-Identifier: MIT
// Stair evidence (paper, "Support-Aware Voxel Types" and sec. "Stair-State Promotion"): mask pixels
// lifted to 3D, scored and remembered. Evidence alone never changes a voxel's state.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/planner/astar.h"
#include "crossnav/policy/candidates.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::policy {

/// Record of a surface voxel seen as a stair.
struct StairVoxel {
  double probability = 0;     ///< best mask probability seen
  double geometry_score = 0;  ///< of the best component it was part of
  std::uint32_t recent = 0;   ///< bit k: accepted k frames before `last_step`
  int last_step = 0;
  bool is_confirmed = false;  ///< accepted in enough of the last frames, at some time
};

class StairEvidence {
 public:
  /// Adds one frame: components of the mask, lifted through `ends` of the map's integration.
  void Update(const Image<float>& probability, const std::vector<geometry::EndRun>& ends,
              const VoxelMap& map, const StairConfig& config, int step);

  const std::map<VoxelKey, StairVoxel>& voxels() const { return voxels_; }

  /// Grows when a voxel is new, newly confirmed or rejected.
  std::uint64_t revision() const { return revision_; }
  /// Stair voxels of the last frame with the geometry of stairs.
  const std::vector<VoxelKey>& last_seen() const { return last_seen_; }

  /// For files: records without the step count, in order of key; and back.
  std::vector<geometry::SeenStair> Export() const;
  void Import(const std::vector<geometry::SeenStair>& seen);

  /// Forgets evidence in the cylinder (after a rejected entrance); returns the keys.
  std::vector<VoxelKey> Reject(const Vector3d& p_world, double radius_m, double voxel_m);

 private:
  std::map<VoxelKey, StairVoxel> voxels_;
  std::vector<VoxelKey> last_seen_;
  std::uint64_t revision_ = 0;
};

/// A flight as seen from one level: the part of the evidence that leads away from it.
struct Flight {
  std::vector<VoxelKey> voxels;                  ///< sorted
  int direction = 0;                             ///< +1 leads up, -1 leads down
  Vector3d p_entrance_world = Vector3d::Zero();  ///< centre of the step next to the level
  Vector3d p_ahead_world = Vector3d::Zero();     ///< centre of the evidence within a metre or so
  double geometry_score = 0;
  double probability = 0;  ///< mean mask probability
  bool is_confirmed = false;
};

/// Flights that leave the level at height `level_m` in `direction`.
std::vector<Flight> FlightsFrom(const StairEvidence& evidence, const VoxelMap& map, double level_m,
                                int direction);

/// Ascent Frontiers: confirmed flights up with an accepted score and a place in front of them.
std::vector<Candidate> AscentFrontiers(const std::vector<Flight>& flights_up, const VoxelMap& map,
                                       const planner::LevelBand& level, const StairConfig& config);

}  // namespace crossnav::policy
