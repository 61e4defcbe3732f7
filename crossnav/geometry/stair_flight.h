// SPDX-License-Identifier: MIT
// Stairs as they outlive a goal and are saved with the memory: flights as objects that link two
// floors, and voxels seen as stairs. World frame, metres.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::geometry {

/// Why an attempt to take a flight ended before its other end. Reaches disk as a number.
enum class TryEnding {
  kNotOpened,    ///< arrived, and looking at the target changed nothing
  kNoProgress,   ///< the path did not get shorter for too long
  kUnreachable,  ///< no path any more
  kGivenUp,      ///< the paper's session failed
};
inline constexpr int kTryEndings = 4;
std::string_view NameOf(TryEnding ending);

struct FlightTry {
  Vector3d p_from_world = Vector3d::Zero();  ///< foot of the agent when it gave up
  bool is_up = true;
  TryEnding ending = TryEnding::kGivenUp;

  friend bool operator==(const FlightTry&, const FlightTry&) = default;
};

/// A flight that was walked, or that stair evidence alone tells of.
struct StairFlight {
  int id = -1;                               ///< from 0, in order of discovery; kept for good
  Vector3d p_foot_world = Vector3d::Zero();  ///< lower end: flat ground, or the lowest tread seen
  Vector3d p_top_world = Vector3d::Zero();   ///< upper end: flat ground, or the highest tread seen
  /// From foot to top: where a foot was put or, not walked yet, the treads that were seen.
  std::vector<Vector3d> steps_world;
  /// Walked: share of the steps at which stair evidence was seen. Else: mean probability of the
  /// mask on its treads. [0, 1]
  double confidence = 0;
  int walked_up = 0;
  int walked_down = 0;
  std::vector<Vector3d> seen_from_world;  ///< feet of the agent, at least a metre apart
  std::vector<FlightTry> tries;           ///< in order

  bool IsWalked() const { return walked_up + walked_down > 0; }
  /// Unit vector in the plane, from the foot towards the steps within the first metre and a half;
  /// zero where there are none.
  Vector3d DirectionUp() const;

  friend bool operator==(const StairFlight&, const StairFlight&) = default;
};

/// Surface voxel with stair pixels, reduced to the members that policy::StairVoxel keeps.
struct SeenStair {
  VoxelKey key;
  float probability = 0;     ///< best of the mask there [0, 1]
  float geometry_score = 0;  ///< best of a component it was part of [0, 1]
  bool is_confirmed = false;
};

}  // namespace crossnav::geometry
