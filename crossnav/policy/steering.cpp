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
constexpr double kClearanceCap_m = 0.25;
constexpr double kWantedClearance_m = 0.15;  // chosen: the body's radius and half a voxel
constexpr double kClearanceWeight =
    10;  // chosen: a step that touches costs as much as a detour of 85 degrees
constexpr int kForgetSteps = 100;  // chosen: temporary obstacles are forgotten after this

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

double ClearanceAt(const VoxelMap& map, const Vector3d& p_world) {
  const double voxel_m = map.config().voxel_m;
  const VoxelKey foot = geometry::KeyOf(p_world + Vector3d(0, 0, 0.5 * voxel_m), voxel_m);
  const int climb = CellsFloor(map.config().max_climb_m, voxel_m),
            height = CellsFloor(map.config().agent_height_m, voxel_m);
  VoxelMap::Cursor cursor(map);
  int ground = foot.z - 1;
  for (int dz = climb + 1; dz >= -6; --dz) {
    if (!IsSurface(cursor.At({foot.x, foot.y, foot.z + dz}).state)) continue;
    ground = foot.z + dz;
    break;
  }
  double nearest = kClearanceCap_m;
  const int reach = CellsCeil(kClearanceCap_m, voxel_m);
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy) {
      const Vector3d corner = geometry::MinCornerOf({foot.x + dx, foot.y + dy, 0}, voxel_m);
      const double ox =
          std::max({corner.x() - p_world.x(), 0.0, p_world.x() - corner.x() - voxel_m});
      const double oy =
          std::max({corner.y() - p_world.y(), 0.0, p_world.y() - corner.y() - voxel_m});
      const double distance = std::hypot(ox, oy);
      if (distance >= nearest) continue;
      for (int z = ground + climb + 1; z <= ground + height; ++z) {
        if (!IsSurface(cursor.At({foot.x + dx, foot.y + dy, z}).state)) continue;
        nearest = distance;
        break;
      }
    }
  return nearest;
}

Action SteerTowards(const VoxelMap& map, const AgentPose& agent, const Vector3d& p_waypoint_world,
                    const std::set<VoxelKey>* obstacles, const ActionConfig& action) {
  const double turn_rad = DegToRad(action.turn_deg), voxel_m = map.config().voxel_m;
  const int turns = static_cast<int>(std::lround(360.0 / action.turn_deg));
  const Vector3d d = p_waypoint_world - agent.p_world;
  const double wanted = std::atan2(d.y(), d.x());
  int best_turn = 0;
  double best_cost = 1e9;
  for (int i = 0; i < turns; ++i) {
    const int k = i % 2 ? (i + 1) / 2 : -(i / 2);  // 0, 1, -1, 2, ...: ties go to the smaller turn
    const double yaw = agent.yaw_rad + k * turn_rad;
    double cost = std::abs(WrapAngle(yaw - wanted));
    double clearance = kClearanceCap_m;
    for (const double share : {0.5, 1.0}) {
      const double ahead = share * action.forward_m;
      const Vector3d p = agent.p_world + Vector3d(std::cos(yaw) * ahead, std::sin(yaw) * ahead, 0);
      clearance = std::min(clearance, ClearanceAt(map, p));
      const VoxelKey key = geometry::KeyOf(p + Vector3d(0, 0, 0.5 * voxel_m), voxel_m);
      if (obstacles && obstacles->contains(key)) cost += 3;
    }
    cost += kClearanceWeight * std::max(0.0, kWantedClearance_m - clearance);
    if (cost < best_cost - 1e-9) {
      best_cost = cost;
      best_turn = k;
    }
  }
  if (best_turn == 0) return Action::kMoveForward;
  return best_turn > 0 ? Action::kTurnLeft : Action::kTurnRight;
}

std::optional<Action> PitchTowards(const AgentPose& agent, double wanted_rad,
                                   const ActionConfig& action) {
  if (action.max_pitch_deg == 0) return std::nullopt;  // the camera is fixed
  const double error = wanted_rad - agent.pitch_rad;
  if (std::abs(error) <= DegToRad(action.pitch_deg) / 2 + 1e-6) return std::nullopt;
  return error > 0 ? Action::kLookUp : Action::kLookDown;
}

std::vector<Action> EscapeActions(const VoxelMap& map, const AgentPose& agent,
                                  const std::vector<double>& tried_yaw_rad,
                                  const ActionConfig& action) {
  const double voxel_m = map.config().voxel_m, turn_rad = DegToRad(action.turn_deg);
  const int turns = static_cast<int>(std::lround(360.0 / action.turn_deg));
  VoxelMap::Cursor cursor(map);
  int best_turn = turns / 2;
  double best_score = -1;
  for (int k = -turns / 2 + 1; k <= turns / 2; ++k) {
    const double yaw = agent.yaw_rad + k * turn_rad;
    const bool is_tried = std::any_of(
        tried_yaw_rad.begin(), tried_yaw_rad.end(),
        [&](double tried) { return std::abs(WrapAngle(yaw - tried)) < 0.5 * turn_rad; });
    double score = is_tried ? -0.5 : 0;
    for (double ahead = voxel_m; ahead < 1.0; ahead += voxel_m) {
      const Vector3d p =
          agent.p_world + Vector3d(std::cos(yaw) * ahead, std::sin(yaw) * ahead, 0.5 * voxel_m);
      const VoxelKey key = geometry::KeyOf(p, voxel_m);
      if (is_tried || !IsWalkable(cursor, key, true)) break;
      score += IsWalkable(cursor, key, false) ? 1.0 : 0.5;
    }
    if (score > best_score + 1e-9 ||
        (score > best_score - 1e-9 && std::abs(k) < std::abs(best_turn))) {
      best_score = score;
      best_turn = k;
    }
  }
  std::vector<Action> actions(static_cast<std::size_t>(std::abs(best_turn)),
                              best_turn > 0 ? Action::kTurnLeft : Action::kTurnRight);
  actions.push_back(Action::kMoveForward);
  return actions;
}

bool BumpMonitor::Update(const AgentPose& agent, int step, const geometry::MapConfig& map) {
  if (step - last_bump_step_ > kForgetSteps) obstacles_.clear();
  if (!before_) return false;
  const AgentPose before = *before_;
  before_.reset();
  if ((agent.p_world - before.p_world).norm() >= kBumpMoved_m) {
    bumps_ = 0;
    bumped_yaws_.clear();
    return false;
  }
  ++bumps_;
  bumped_yaws_.push_back(agent.yaw_rad);
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
