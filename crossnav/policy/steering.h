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

/// Turn towards the waypoint when the heading is off by more than half a turn, else walk.
Action SteerTowards(const AgentPose& agent, const Vector3d& p_waypoint_world,
                    const ActionConfig& action);

/// Turns `pitch_rad` one step towards `wanted_rad`; nullopt when nearer than half a step.
std::optional<Action> PitchTowards(const AgentPose& agent, double wanted_rad,
                                   const ActionConfig& action);

/// Remembers forward steps that did not move the agent, and what stood in the way.
class BumpMonitor {
 public:
  /// Call before planning, with the pose after the last action. True if that action was a bump.
  bool Update(const AgentPose& agent, int step, const geometry::MapConfig& map);
  /// Call with the action about to be executed.
  void Commit(Action action, const AgentPose& agent);

  /// Voxels not to be planned through for a while.
  const std::set<geometry::VoxelKey>& obstacles() const { return obstacles_; }
  void Clear() { obstacles_.clear(); }

 private:
  std::set<geometry::VoxelKey> obstacles_;
  std::optional<AgentPose> before_;  // pose before the last forward
  int bumps_ = 0;
  int last_bump_step_ = -1000;
};

}  // namespace crossnav::policy
