// SPDX-License-Identifier: MIT
#include "crossnav/policy/ground_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using planner::GroundMap;

constexpr double kSamePosition_m = 0.05;  // chosen: nearer positions are the same
constexpr double kRoomToTurn_vox = 15;    // chosen: room to turn around in beside the path
constexpr int kMaxExpansions = 600;  // chosen: a few times those of a turn around in a corridor
constexpr double kUnseenCost = 3;    // chosen: [steps] onto ground that was not seen
constexpr std::size_t kWindow = 30;  // chosen: places of the path that are searched

/// Cost-to-go [m] to the end of the path's near part, for every position from which that end is
/// reachable. The search goes from that end to the agent. A path steps down where no step up is
/// known, so that the search may need rises like seats, or a nearer end: a way back elsewhere would
/// lead the agent away from the path.
class CostToGo {
 public:
  CostToGo(const GroundMap& ground, const planner::PlannerConfig& planner,
           const std::vector<VoxelKey>& path, planner::GroundRules rules)
      : ground_(ground), search_(From(path, kWindow, planner, rules)) {
    if (GoesAlong(path, kWindow)) return;
    rules.may_step_on_seats = true;
    for (std::size_t places = kWindow; places > 1; places /= 2) {
      search_ = From(path, places, planner, rules);
      if (GoesAlong(path, places)) return;
    }
  }
  double At(const Eigen::Vector2d& p, int z) const {
    const double voxel_m = ground_.voxel_m();
    const VoxelKey key = geometry::KeyOf({p.x(), p.y(), 0}, voxel_m);
    double best_m = std::numeric_limits<double>::infinity();
    for (int dx = -2; dx <= 2; ++dx)
      for (int dy = -2; dy <= 2; ++dy) {
        const auto near_z = ground_.StandingNear(key.x + dx, key.y + dy, z, ground_.climb());
        if (!near_z || !IsOpenBetween(key, dx, dy, z)) continue;
        const VoxelKey near{key.x + dx, key.y + dy, *near_z};
        const auto cost = search_.CostOf(near);
        if (!cost) continue;
        best_m = std::min(best_m, *cost * voxel_m + (CenterOf(near, voxel_m).head<2>() - p).norm());
      }
    return best_m;
  }

 private:
  /// Whether there is ground on the way to a column two away: a wall can be one voxel thick.
  bool IsOpenBetween(const VoxelKey& key, int dx, int dy, int z) const {
    if (std::abs(dx) < 2 && std::abs(dy) < 2) return true;
    const auto is_ground = [&](int x, int y) {
      return ground_.StandingNear(key.x + x, key.y + y, z, ground_.climb()).has_value();
    };
    const int x = dx / 2, y = dy / 2;  // toward zero
    if (is_ground(x, y)) return true;
    if (std::abs(dx) == 1) return is_ground(dx, y);
    if (std::abs(dy) == 1) return is_ground(x, dy);
    return false;
  }

  /// Whether the search reached each of the first `places` of the path.
  bool GoesAlong(const std::vector<VoxelKey>& path, std::size_t places) const {
    const auto end = path.begin() + static_cast<std::ptrdiff_t>(std::min(path.size(), places));
    return std::all_of(path.begin(), end,
                       [&](const VoxelKey& key) { return search_.CostOf(key).has_value(); });
  }

  planner::GroundSearch From(const std::vector<VoxelKey>& path, std::size_t places,
                             const planner::PlannerConfig& planner,
                             const planner::GroundRules& rules) const {
    planner::GroundSearch search(ground_, planner, path[std::min(path.size(), places) - 1], rules);
    // Beyond the agent as well, for positions beside the path.
    double limit = 1e18;
    while (search.Next() && search.cost() <= limit)
      if (limit > 1e17 && search.CostOf(path.front())) limit = search.cost() + kRoomToTurn_vox;
    return search;
  }

  const GroundMap& ground_;
  planner::GroundSearch search_;
};

struct Node {
  Eigen::Vector2d p;
  int z = 0;        // place to stand [voxels]
  int turn = 0;     // heading against the agent's, in turns
  double cost = 0;  // [steps]
  int parent = -1;
  Action action = Action::kStop;
  int depth = 0;
};

/// Whether ground continues within a tread's depth ahead of a place over unseen ground.
bool GoesOn(const GroundMap& ground, const Eigen::Vector2d& p, int z, double yaw_rad) {
  for (int k = 1; k <= 3; ++k) {
    const Eigen::Vector2d q =
        p + k * ground.voxel_m() * Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
    const VoxelKey key = geometry::KeyOf({q.x(), q.y(), 0}, ground.voxel_m());
    if (ground.StandingNear(key.x, key.y, z, ground.climb())) return true;
  }
  return false;
}

/// Extra cost of a forward step [steps], or nothing if it is refused.
std::optional<double> StepPenalty(const GroundMap& ground, const Eigen::Vector2d& from, int z_from,
                                  double yaw_rad, const MotionConfig& config,
                                  const ActionConfig& action, int* z_to) {
  const double voxel_m = ground.voxel_m();
  const auto room = [&](const Eigen::Vector2d& p, int z) {
    return ground.DistanceToObstacle({p.x(), p.y(), z * voxel_m}, z, config.wanted_clearance_m);
  };
  const double room_before = room(from, z_from);
  double penalty = 0;
  int z = z_from;
  for (const double share : {1.0 / 3, 2.0 / 3, 1.0}) {
    const Eigen::Vector2d p =
        from + share * action.forward_m * Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
    const VoxelKey key = geometry::KeyOf({p.x(), p.y(), 0}, voxel_m);
    const VoxelKey here = geometry::KeyOf({from.x(), from.y(), 0}, voxel_m);
    if (const auto next = ground.StandingNear(key.x, key.y, z, ground.climb())) {
      z = *next;
    } else if (key.x != here.x || key.y != here.y) {
      int unused = 0;
      const planner::StepOutcome outcome = ground.OutcomeOf({key.x, key.y, z}, 0, 0, &unused);
      if (outcome == planner::StepOutcome::kBlocked) return std::nullopt;
      if (outcome == planner::StepOutcome::kDrop && !GoesOn(ground, p, z, yaw_rad))
        return std::nullopt;
      penalty += kUnseenCost / 3;
    }
    const double clear_m = room(p, z);
    if (clear_m < config.min_clearance_m && clear_m < room_before + 1e-6) return std::nullopt;
    penalty = std::max(penalty, config.clearance_weight * (config.wanted_clearance_m - clear_m) /
                                    config.wanted_clearance_m);
  }
  *z_to = z;
  return penalty;
}

class LatticeSearch {
 public:
  LatticeSearch(const GroundMap& ground, const CostToGo& cost_to_go, const AgentPose& agent,
                const MotionConfig& config, const ActionConfig& action)
      : ground_(ground),
        cost_to_go_(cost_to_go),
        agent_(agent),
        config_(config),
        action_(action),
        turns_(static_cast<int>(std::lround(360.0 / action.turn_deg))) {}

  std::vector<Action> Run(int z_start) {
    Add({agent_.p_world.head<2>(), z_start, 0, 0, -1, Action::kStop, 0});
    const double start_m = cost_to_go_.At(nodes_[0].p, z_start);
    int best = -1;
    const double worth = start_m / action_.forward_m - config_.min_gain_steps;
    double best_value = worth;
    for (int expanded = 0; !open_.empty() && expanded < kMaxExpansions; ++expanded) {
      const int index = open_.top().second;
      open_.pop();
      const Node node = nodes_[static_cast<std::size_t>(index)];
      if (node.cost > seen_[CellOf(node)] + 1e-9) continue;
      const double rest_m = cost_to_go_.At(node.p, node.z);
      // The best place so far is kept for the case that the horizon is never reached.
      if (rest_m / action_.forward_m < best_value - 1e-9) {
        best_value = rest_m / action_.forward_m;
        best = index;
      }
      const bool is_there = rest_m <= config_.arrival_m && node.parent >= 0;
      const bool is_far = node.depth >= config_.horizon_steps;
      // Where the path is closed to the body, walking elsewhere is no progress.
      if (is_there || (is_far && rest_m / action_.forward_m < worth)) return ActionsTo(index);
      if (is_far) continue;
      Expand(index, node);
    }
    return best < 0 ? std::vector<Action>() : ActionsTo(best);
  }

 private:
  VoxelKey CellOf(const Node& node) const {
    return {static_cast<int>(std::floor(node.p.x() / kSamePosition_m)),
            static_cast<int>(std::floor(node.p.y() / kSamePosition_m)), node.turn};
  }
  int Wrapped(int turn) const {
    turn = (turn % turns_ + turns_) % turns_;
    return turn > turns_ / 2 ? turn - turns_ : turn;
  }

  void Add(const Node& node) {
    const auto [it, is_new] = seen_.try_emplace(CellOf(node), node.cost);
    if (!is_new && node.cost >= it->second - 1e-9) return;
    it->second = node.cost;
    nodes_.push_back(node);
    open_.push({-(node.cost + cost_to_go_.At(node.p, node.z) / action_.forward_m),
                static_cast<int>(nodes_.size()) - 1});
  }

  void Expand(int index, const Node& node) {
    for (const int by : {1, -1}) {
      // Turning back and forth leads nowhere.
      const Action turn = by > 0 ? Action::kTurnLeft : Action::kTurnRight;
      if (node.action == (by > 0 ? Action::kTurnRight : Action::kTurnLeft)) continue;
      Node next = node;
      next.turn = Wrapped(node.turn + by);
      next.cost += config_.turn_steps;
      next.parent = index;
      next.action = turn;
      Add(next);
    }
    const double yaw = agent_.yaw_rad + node.turn * DegToRad(action_.turn_deg);
    Node next = node;
    const auto penalty = StepPenalty(ground_, node.p, node.z, yaw, config_, action_, &next.z);
    if (!penalty) return;
    next.p += action_.forward_m * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    next.cost += 1 + *penalty;
    next.parent = index;
    next.action = Action::kMoveForward;
    ++next.depth;
    Add(next);
  }

  std::vector<Action> ActionsTo(int index) const {
    std::vector<Action> actions;
    for (; nodes_[static_cast<std::size_t>(index)].parent >= 0;
         index = nodes_[static_cast<std::size_t>(index)].parent)
      actions.push_back(nodes_[static_cast<std::size_t>(index)].action);
    std::reverse(actions.begin(), actions.end());
    // Turns at the end lead to no step.
    while (!actions.empty() && actions.back() != Action::kMoveForward) actions.pop_back();
    return actions;
  }

  const GroundMap& ground_;
  const CostToGo& cost_to_go_;
  const AgentPose& agent_;
  const MotionConfig& config_;
  const ActionConfig& action_;
  int turns_;
  std::vector<Node> nodes_;
  std::map<VoxelKey, double> seen_;
  std::priority_queue<std::pair<double, int>> open_;  // best first: smallest estimate, latest node
};

}  // namespace

std::vector<Action> MotionAlong(const GroundMap& ground, const std::vector<VoxelKey>& path,
                                const AgentPose& agent, const MotionConfig& config,
                                const planner::PlannerConfig& planner, const ActionConfig& action,
                                const planner::GroundRules& rules) {
  if (path.empty()) return {};
  const CostToGo cost_to_go(ground, planner, path, rules);
  return LatticeSearch(ground, cost_to_go, agent, config, action).Run(path.front().z);
}

bool IsStepClear(const GroundMap& ground, const AgentPose& agent, const MotionConfig& config,
                 const ActionConfig& action) {
  const auto here = ground.StandingAt(agent.p_world);
  if (!here) return true;
  int z = 0;
  return StepPenalty(ground, agent.p_world.head<2>(), here->z, agent.yaw_rad, config, action, &z)
      .has_value();
}

}  // namespace crossnav::policy
