// SPDX-License-Identifier: MIT
// From a planned path to one of the six actions: turn towards a visible waypoint ahead, then walk.
// Notices when a forward step did not move the agent. World frame, metres.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/pose.h"
#include "crossnav/planner/astar.h"

namespace crossnav::policy {

/// The farthest point of `path` within `lookahead_m` that can be walked to in a straight line.
Vector3d VisibleWaypoint(const geometry::VoxelMap& map, const std::vector<geometry::VoxelKey>& path,
                         const Vector3d& p_world_foot, const planner::GraphRules& rules);

/// Picks, of the reachable headings with a clear next step, the heading nearest to the waypoint's
/// direction; returns a turn towards it, or the step.
Action SteerTowards(const geometry::VoxelMap& map, const AgentPose& agent,
                    const Vector3d& p_waypoint_world, const std::set<geometry::VoxelKey>* obstacles,
                    const ActionConfig& action);

/// Distance from `p_world` (at foot height) to the nearest column that blocks a body, capped at
/// 0.25 [m]. Blocking: a surface more than the maximum climb and at most the agent's height above
/// the ground at `p_world`.
double ClearanceAt(const geometry::VoxelMap& map, const Vector3d& p_world);

/// Turns `pitch_rad` one step towards `wanted_rad`; nullopt when nearer than half a step.
std::optional<Action> PitchTowards(const AgentPose& agent, double wanted_rad,
                                   const ActionConfig& action);

/// Turns and one step into the untried direction with the longest free path, to leave a tight
/// spot.
std::vector<Action> EscapeActions(const geometry::VoxelMap& map, const AgentPose& agent,
                                  const std::vector<double>& tried_yaw_rad,
                                  const ActionConfig& action);

/// Remembers forward steps without motion, and the obstacles that caused them.
class BumpMonitor {
 public:
  /// Call before planning, with the pose after the last action. True if that action was a bump.
  bool Update(const AgentPose& agent, int step, const geometry::MapConfig& map);
  /// Call with the action about to be executed.
  void Commit(Action action, const AgentPose& agent);

  /// Bumps at one place without any movement in between.
  int bumps_in_place() const { return bumps_; }
  /// Headings of these bumps [rad].
  const std::vector<double>& bumped_yaws() const { return bumped_yaws_; }

  /// Voxels not to be planned through for a while.
  const std::set<geometry::VoxelKey>& obstacles() const { return obstacles_; }
  void Clear() { obstacles_.clear(); }

 private:
  std::set<geometry::VoxelKey> obstacles_;
  std::optional<AgentPose> before_;  // pose before the last forward
  int bumps_ = 0;
  std::vector<double> bumped_yaws_;
  int last_bump_step_ = -1000;
};

}  // namespace crossnav::policy
