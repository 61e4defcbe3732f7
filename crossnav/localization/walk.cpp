// SPDX-License-Identifier: MIT
#include "crossnav/localization/walk.h"

#include <algorithm>
#include <cmath>

#include "crossnav/localization/scouting.h"
#include "crossnav/policy/ground_motion.h"

namespace crossnav::localization {
namespace {

constexpr double kArrived_m = 0.4;   // chosen: nearer places have about the same view
constexpr int kMostOthers = 3;       // chosen: rivals that an outlook is to separate
constexpr int kMostFailures = 4;     // chosen: blocked walks before the robot gives up
constexpr double kBeside_m = 0.05;   // chosen: half a voxel beside the body
constexpr double kBump_m = 0.1;      // chosen: a shorter step was blocked
constexpr std::size_t kTrusted = 3;  // chosen: actions until the motion is planned anew

AgentPose InMap(const Pose& T_map_odom, const AgentPose& foot_odom) {
  return {T_map_odom * foot_odom.p_world, WrapAngle(foot_odom.yaw_rad + YawOf(T_map_odom)),
          foot_odom.pitch_rad};
}

/// Places to stand from the foot to the target; empty without a path.
std::vector<geometry::VoxelKey> PathTo(const PlacedMap& map, const Vector3d& p_foot_map,
                                       const Vector3d& p_target_map) {
  const auto start = map.ground.StandingAt(p_foot_map);
  const auto end = map.ground.StandingAt(p_target_map);
  if (!start || !end) return {};
  const planner::PlannerConfig planner;
  planner::GroundSearch search(map.ground, planner, *start);
  while (const auto key = search.Next())
    if (*key == *end) return search.PathTo(*end);
  return {};
}

}  // namespace

bool IsWayClear(const std::vector<Vector3f>& points_odom, const AgentPose& foot_odom,
                const Body& body) {
  const double c = std::cos(foot_odom.yaw_rad), s = std::sin(foot_odom.yaw_rad);
  const double climb_m = body.map.max_climb_m + body.map.voxel_m / 2;
  const double wide_m = body.map.agent_radius_m + kBeside_m;
  const double far_m = body.action.forward_m + body.map.agent_radius_m;
  int in_the_way = 0, ground = 0, below = 0;
  for (const Vector3f& p : points_odom) {
    const Vector3d d = p.cast<double>() - foot_odom.p_world;
    const double ahead_m = c * d.x() + s * d.y(), aside_m = std::abs(c * d.y() - s * d.x());
    if (ahead_m < 0.05 || ahead_m > far_m || aside_m > wide_m) continue;
    if (d.z() > climb_m && d.z() < body.map.agent_height_m) ++in_the_way;
    if (std::abs(d.z()) <= climb_m) ++ground;
    if (d.z() < -climb_m) ++below;
  }
  return in_the_way < 2 && (below == 0 || ground > 0);
}

std::optional<Action> Walk::Next(const PlacedMap& map, const Body& body, const LocalScan& scan,
                                 const Belief& belief, const AgentPose& foot_odom) {
  has_arrived_ = false;
  if (belief.hypotheses().empty()) return std::nullopt;
  while (failures_ < kMostFailures) {
    if (!p_target_odom_ && !SetOut(map, body, belief, foot_odom)) return std::nullopt;
    const Eigen::Vector2d left = (*p_target_odom_ - foot_odom.p_world).head<2>();
    has_arrived_ = left.norm() < kArrived_m;
    if (has_arrived_) break;
    if (auto action = Follow(map, body, scan, belief.hypotheses().front().T_map_odom, foot_odom))
      return action;
    ++failures_;
    p_target_odom_.reset();
  }
  p_target_odom_.reset();
  return std::nullopt;
}

bool Walk::SetOut(const PlacedMap& map, const Body& body, const Belief& belief,
                  const AgentPose& foot_odom) {
  const std::vector<Hypothesis>& hypotheses = belief.hypotheses();
  const int others = std::max(1, belief.opinion().rivals);
  motion_.clear();
  p_before_odom_.reset();
  const int most = std::min(kMostOthers, static_cast<int>(hypotheses.size()) - 1);
  const Outlook outlook =
      FindOutlook(map.dense, map.ground, hypotheses, std::clamp(others, 0, most), foot_odom.p_world,
                  body.camera_height_m);
  if (outlook.path_map.empty()) return false;
  p_target_odom_ = hypotheses.front().T_map_odom.inverse() *
                   geometry::CenterOf(outlook.path_map.back(), map.dense.voxel_m);
  return true;
}

std::optional<Action> Walk::Follow(const PlacedMap& map, const Body& body, const LocalScan& scan,
                                   const Pose& T_map_odom, const AgentPose& foot_odom) {
  const bool has_bumped = p_before_odom_ && (*p_before_odom_ - foot_odom.p_world).norm() < kBump_m;
  p_before_odom_.reset();
  if (has_bumped) return std::nullopt;
  if (motion_.empty()) {
    const AgentPose foot_map = InMap(T_map_odom, foot_odom);
    const auto path = PathTo(map, foot_map.p_world, T_map_odom * *p_target_odom_);
    if (path.empty()) return std::nullopt;
    const auto motion = policy::MotionAlong(map.ground, path, foot_map, {}, {}, body.action);
    motion_.assign(motion.begin(), motion.begin() + std::min(kTrusted, motion.size()));
  }
  if (motion_.empty()) return std::nullopt;
  const Action action = motion_.front();
  motion_.pop_front();
  if (action != Action::kMoveForward) return action;
  if (!IsWayClear(scan.points_odom(), foot_odom, body)) return std::nullopt;
  p_before_odom_ = foot_odom.p_world;
  return action;
}

}  // namespace crossnav::localization
