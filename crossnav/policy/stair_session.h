// SPDX-License-Identifier: MIT
// A StairSem session (paper, "Stair-State Promotion" and Table tab:supp_navigation_modes):
// promotion of verified evidence, stair frontiers at the advancing end, and the confirmation of a
// landing. World frame, metres.
#pragma once

#include <set>
#include <string_view>
#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/policy/candidates.h"
#include "crossnav/policy/policy_config.h"
#include "crossnav/policy/stair_evidence.h"

namespace crossnav::policy {

struct StairSession {
  int direction = 1;  ///< +1 up, -1 down
  double entrance_level_m = 0;
  Vector3d p_entrance_world = Vector3d::Zero();  ///< where the agent stood when it began
  std::set<VoxelKey> cluster;                    ///< voxels promoted in this session
  double best_progress_m = 0;  ///< largest rise (or drop) of the agent since the entrance
  int steps_without_progress = 0;
  int landing_frames = 0;  ///< consecutive frames of flat ground away from the entrance
  int steps = 0;
};

/// How the session stands after a step.
enum class SessionStatus { kClimbing, kOnLanding, kStalled };

StairSession BeginSession(int direction, double entrance_level_m, const Vector3d& p_world_foot,
                          const std::vector<VoxelKey>& flight);

/// Within the admission radius of the session's cluster, accepted evidence becomes STAIR, OCCUPIED
/// neighbours within a climb become STAIR_EXPANDED, and rejected evidence becomes FAKE_STAIR, which
/// later evidence may still promote. The caller updates the map's states.
void PromoteStairs(StairSession& session, const StairEvidence& evidence, VoxelMap& map,
                   const StairConfig& config);

/// Counts progress and landing frames for the agent at `p_world_foot`.
SessionStatus AdvanceSession(StairSession& session, const VoxelMap& map,
                             const Vector3d& p_world_foot, const StairConfig& config);

/// Stair Frontiers, highest progress in the session's direction first: places on the landing beyond
/// the flight, then the advancing end of the flight, then intermediate steps.
std::vector<Candidate> StairFrontiers(const StairSession& session, const VoxelMap& map,
                                      const Vector3d& p_world_foot);

/// A landing from which another flight continues in the same direction, and which is too small to
/// be a floor: the session goes on.
bool FlightContinues(const StairSession& session, const StairEvidence& evidence,
                     const VoxelMap& map, const Vector3d& p_world_foot, const StairConfig& config);

}  // namespace crossnav::policy
