// SPDX-License-Identifier: MIT
#include "crossnav/policy/steering.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/cells.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;

constexpr double kLookahead_m = 1.5;   // chosen: six forward steps
constexpr double kBumpMoved_m = 0.12;  // chosen: less than half a forward step
constexpr int kForgetSteps = 100;      // chosen: temporary obstacles are forgotten after this

/// Some free standing air within two voxels of height at `p`.
bool IsWalkable(VoxelMap::Cursor& cursor, const VoxelKey& key, bool allow_inflated) {
  for (const int dz : {0, 1, -1, 2, -2}) {
    const geometry::Voxel voxel = cursor.At({key.x, key.y, key.z + dz});
    if (IsPathable(voxel.state) && !IsSurface(voxel.state) &&
        (allow_inflated || !voxel.is_inflated))
      return true;
  }
  return false;
}

bool CanWalkStraight(const VoxelMap& map, const Vector3d& from, const Vector3d& to,
                     const planner::GraphRules& rules) {
  const double voxel_m = map.config().voxel_m;
  VoxelMap::Cursor cursor(map);
  const double length = (to - from).head<2>().norm();
  const int samples = std::max(1, CellsCeil(length, 0.5 * voxel_m));
  for (int i = 1; i <= samples; ++i) {
    const Vector3d p = from + (to - from) * (static_cast<double>(i) / samples);
    const VoxelKey key = geometry::KeyOf(p, voxel_m);
    if (rules.obstacles && rules.obstacles->contains(key)) return false;
    // The agent may stand inside inflation; it only has to leave it.
    const bool is_near_start = (p - from).head<2>().norm() < 0.3;
    if (!IsWalkable(cursor, key, rules.allow_inflated || is_near_start)) return false;
  }
  return true;
}

}  // namespace

Vector3d VisibleWaypoint(const VoxelMap& map, const std::vector<VoxelKey>& path,
                         const Vector3d& p_world_foot, const planner::GraphRules& rules) {
  const double voxel_m = map.config().voxel_m;
  const Vector3d p_from = p_world_foot + Vector3d(0, 0, 0.5 * voxel_m);
  Vector3d p_best = CenterOf(path.back(), voxel_m);
  bool is_set = false;
  for (const VoxelKey& key : path) {
    const Vector3d p = CenterOf(key, voxel_m);
    const double distance = (p - p_from).head<2>().norm();
    if (distance > kLookahead_m) break;
    if (distance < 0.15) continue;
    if (is_set && !CanWalkStraight(map, p_from, p, rules)) continue;
    p_best = p;
    is_set = true;
  }
  return p_best;
}

Action SteerTowards(const AgentPose& agent, const Vector3d& p_waypoint_world,
                    const ActionConfig& action) {
  const Vector3d d = p_waypoint_world - agent.p_world;
  const double error = WrapAngle(std::atan2(d.y(), d.x()) - agent.yaw_rad);
  if (std::abs(error) <= DegToRad(action.turn_deg) / 2 + 1e-6) return Action::kMoveForward;
  return error > 0 ? Action::kTurnLeft : Action::kTurnRight;
}

std::optional<Action> PitchTowards(const AgentPose& agent, double wanted_rad,
                                   const ActionConfig& action) {
  const double error = wanted_rad - agent.pitch_rad;
  if (std::abs(error) <= DegToRad(action.pitch_deg) / 2 + 1e-6) return std::nullopt;
  return error > 0 ? Action::kLookUp : Action::kLookDown;
}

bool BumpMonitor::Update(const AgentPose& agent, int step, const geometry::MapConfig& map) {
  if (step - last_bump_step_ > kForgetSteps) obstacles_.clear();
  if (!before_) return false;
  const AgentPose before = *before_;
  before_.reset();
  if ((agent.p_world - before.p_world).norm() >= kBumpMoved_m) {
    bumps_ = 0;
    return false;
  }
  ++bumps_;
  last_bump_step_ = step;
  if (bumps_ >= 2) {
    const Vector3d forward(std::cos(agent.yaw_rad), std::sin(agent.yaw_rad), 0),
        left(-forward.y(), forward.x(), 0);
    for (const double ahead : {0.15, 0.25, 0.35})
      for (const double side : {-0.1, 0.0, 0.1})
        for (int dz = -1; dz <= 5; ++dz) {
          const VoxelKey key =
              geometry::KeyOf(agent.p_world + forward * ahead + left * side, map.voxel_m);
          obstacles_.insert({key.x, key.y, key.z + dz});
        }
  }
  return true;
}

void BumpMonitor::Commit(Action action, const AgentPose& agent) {
  if (action == Action::kMoveForward)
    before_ = agent;
  else
    before_.reset();
}

}  // namespace crossnav::policy
