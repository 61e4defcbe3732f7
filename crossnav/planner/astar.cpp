// SPDX-License-Identifier: MIT
#include "crossnav/planner/astar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>

#include "crossnav/core/cells.h"
#include "crossnav/geometry/sparse_grid.h"

namespace crossnav::planner {
namespace {

using geometry::FactsOf;
using geometry::IsPathable;
using geometry::IsSurface;
using geometry::kBlockVoxels;
using geometry::Voxel;

constexpr double kSteepest = 1.2;  // chosen: 50 degrees, the steepest flight that counts as a stair
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct NodeBlock {
  std::array<double, kBlockVoxels> cost;
  std::array<VoxelKey, kBlockVoxels> parent;
  std::array<bool, kBlockVoxels> is_closed{};
  NodeBlock() { cost.fill(kInfinity); }
};

struct Open {
  double estimate;
  double cost;
  VoxelKey key;
  /// Total order: smallest estimate, then largest cost so far, then key.
  friend bool operator<(const Open& a, const Open& b) {
    if (a.estimate != b.estimate) return a.estimate > b.estimate;
    if (a.cost != b.cost) return a.cost < b.cost;
    return a.key > b.key;
  }
};

struct Offset {
  VoxelKey d;
  double length;
};

std::vector<Offset> OffsetsWithin(double radius_vox) {
  std::vector<Offset> offsets;
  const int r = static_cast<int>(std::floor(radius_vox + kCellTolerance));
  for (int z = -r; z <= r; ++z)
    for (int y = -r; y <= r; ++y)
      for (int x = -r; x <= r; ++x) {
        const double length = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        if (length > 0 && length <= radius_vox + kCellTolerance)
          offsets.push_back({{x, y, z}, length});
      }
  return offsets;
}

const std::vector<Offset>& Neighbours26() {
  static const std::vector<Offset> offsets = [] {
    std::vector<Offset> all;
    for (const Offset& o : OffsetsWithin(1.75)) all.push_back(o);
    return all;
  }();
  return offsets;
}

class Search {
 public:
  Search(const VoxelMap& map, std::span<const VoxelKey> goals, const GraphRules& rules,
         const PlannerConfig& config)
      : map_(map),
        rules_(rules),
        config_(config),
        cursor_(map),
        nodes_(grid_),
        support_vox_(CellsFloor(map.config().support_depth_m, map.config().voxel_m)) {
    for (std::size_t i = 0; i < goals.size(); ++i) {
      if (FactsOf(map.StateAt(goals[i])).is_targetable) goals_.push_back({goals[i], i});
    }
    std::sort(goals_.begin(), goals_.end());
    if (rules.kind == GraphKind::kStair)
      sphere_ = OffsetsWithin(config.stair_edge_radius_m / map.config().voxel_m);
  }

  Plan Run(const VoxelKey& start) {
    Plan plan;
    if (goals_.empty()) return plan;
    Relax(start, start, 0);
    LeaveBlindRing(start);
    while (!queue_.empty()) {
      const Open next = queue_.top();
      queue_.pop();
      const int cell = geometry::CellIndexOf(next.key);
      NodeBlock& block = nodes_.Touch(next.key);
      if (block.is_closed[cell]) continue;
      block.is_closed[cell] = true;
      if (const auto goal = GoalIndex(next.key)) return Found(start, next, *goal, plan.expansions);
      if (config_.max_expansions > 0 && plan.expansions >= config_.max_expansions) {
        plan.status = PlanStatus::kGaveUp;
        return plan;
      }
      ++plan.expansions;
      Expand(next.key, next.cost);
    }
    return plan;
  }

 private:
  struct Goal {
    VoxelKey key;
    std::size_t index;
    friend auto operator<=>(const Goal&, const Goal&) = default;  // NOLINT: takes 0 for null
  };

  std::optional<std::size_t> GoalIndex(const VoxelKey& key) const {
    const auto it = std::lower_bound(goals_.begin(), goals_.end(), Goal{key, 0});
    if (it == goals_.end() || it->key != key) return std::nullopt;
    return it->index;
  }

  /// Admissible for several goals; with many of them Dijkstra is cheaper than the minimum.
  double Heuristic(const VoxelKey& key) const {
    if (goals_.size() > 8) return 0;
    double nearest = kInfinity;
    for (const Goal& goal : goals_) nearest = std::min(nearest, VoxelDistance(key, goal.key));
    return nearest;
  }

  void LeaveBlindRing(const VoxelKey& start) {
    if (rules_.start_reach_vox <= 1) return;
    const bool is_inside = cursor_.At(start).is_inflated;
    for (const Offset& offset : OffsetsWithin(rules_.start_reach_vox)) {
      const VoxelKey to = start + offset.d;
      const Voxel voxel = cursor_.At(to);
      if (!IsPathable(voxel.state) || IsSurface(voxel.state) || std::abs(offset.d.z) > 2) continue;
      const double edge = EdgeCost(voxel, offset.length, rules_.allow_inflated || is_inside);
      const double voxel_m = map_.config().voxel_m;
      if (edge == kInfinity || !IsBetter(to, edge) || !IsAllowed(start, to, 1)) continue;
      if (map_.HasLineOfSight(CenterOf(start, voxel_m), CenterOf(to, voxel_m)))
        Relax(start, to, edge);
    }
  }

  void Expand(const VoxelKey& from, double cost) {
    const Voxel here = cursor_.At(from);
    const bool may_be_inflated = rules_.allow_inflated || here.is_inflated;
    const auto& offsets = rules_.kind == GraphKind::kStair ? sphere_ : Neighbours26();
    for (const Offset& offset : offsets) {
      const VoxelKey to = from + offset.d;
      const Voxel voxel = cursor_.At(to);
      if (!IsPathable(voxel.state)) continue;
      const double edge = EdgeCost(voxel, offset.length, may_be_inflated);
      if (edge == kInfinity || !IsBetter(to, cost + edge) || !IsAllowed(from, to, offset.length))
        continue;
      Relax(from, to, cost + edge);
    }
  }

  /// eq:supp_astar_edge_cost, infinite where the destination is refused.
  double EdgeCost(const Voxel& to, double length, bool may_be_inflated) const {
    const double cost = length + FactsOf(to.state).penalty;
    if (!to.is_inflated) return cost;
    if (!may_be_inflated) return kInfinity;
    if (rules_.kind == GraphKind::kStair && IsSurface(to.state)) return kInfinity;
    return cost * config_.inflated_cost_factor;
  }

  bool IsAllowed(const VoxelKey& from, const VoxelKey& to, double length) {
    if (rules_.obstacles && rules_.obstacles->contains(to)) return false;
    if (rules_.level && !IsOnLevel(to)) return false;
    return length <= 1.75 || IsBridge(from, to);
  }

  /// A long edge bridges unobserved treads behind their risers; never a wall, an observed drop, an
  /// obstacle, or a rise steeper than a stair.
  bool IsBridge(const VoxelKey& from, const VoxelKey& to) {
    const double run = std::hypot(to.x - from.x, to.y - from.y);
    if (std::abs(to.z - from.z) > kSteepest * run + 1.5) return false;
    const int samples =
        std::max({std::abs(to.x - from.x), std::abs(to.y - from.y), std::abs(to.z - from.z)});
    int unknown = 0;
    for (int i = 1; i < samples; ++i) {
      const double t = static_cast<double>(i) / samples;
      const auto between = [t](int a, int b) {
        return static_cast<std::int32_t>(std::lround(a + t * (b - a)));
      };
      const VoxelKey key{between(from.x, to.x), between(from.y, to.y), between(from.z, to.z)};
      if (rules_.obstacles && rules_.obstacles->contains(key)) return false;
      if (IsDrop(key)) return false;
      const bool is_unknown = cursor_.At(key).state == geometry::VoxelState::kUnknown;
      unknown = is_unknown ? unknown + 1 : 0;
      if (unknown > 1) return false;  // unobserved: the inside of a wall or a flight
    }
    const double voxel_m = map_.config().voxel_m;
    return map_.HasLineOfSight(CenterOf(from, voxel_m), CenterOf(to, voxel_m));
  }

  /// Air was seen for the whole support depth below. Over a hidden tread it was not.
  bool IsDrop(const VoxelKey& key) {
    for (int k = 0; k < support_vox_; ++k) {
      const geometry::VoxelState state = cursor_.At({key.x, key.y, key.z - k}).state;
      if (state == geometry::VoxelState::kUnknown || IsSurface(state)) return false;
    }
    return true;
  }

  bool IsOnLevel(const VoxelKey& key) {
    for (int k = 0; k <= support_vox_; ++k) {
      const VoxelKey below{key.x, key.y, key.z - k};
      if (IsSurface(cursor_.At(below).state)) return rules_.level->Contains(below.z);
    }
    return false;
  }

  bool IsBetter(const VoxelKey& key, double cost) {
    NodeBlock& block = nodes_.Touch(key);
    const int cell = geometry::CellIndexOf(key);
    return !block.is_closed[cell] && cost < block.cost[cell] - 1e-12;
  }

  void Relax(const VoxelKey& from, const VoxelKey& to, double cost) {
    NodeBlock& block = nodes_.Touch(to);
    const int cell = geometry::CellIndexOf(to);
    block.cost[cell] = cost;
    block.parent[cell] = from;
    queue_.push({cost + Heuristic(to), cost, to});
  }

  Plan Found(const VoxelKey& start, const Open& goal, std::size_t index, int expansions) {
    Plan plan;
    plan.status = PlanStatus::kFound;
    plan.cost = goal.cost;
    plan.goal_index = index;
    plan.expansions = expansions;
    for (VoxelKey key = goal.key;; key = nodes_.Touch(key).parent[geometry::CellIndexOf(key)]) {
      plan.path.push_back(key);
      if (key == start) break;
    }
    std::reverse(plan.path.begin(), plan.path.end());
    return plan;
  }

  const VoxelMap& map_;
  const GraphRules& rules_;
  const PlannerConfig& config_;
  VoxelMap::Cursor cursor_;
  geometry::SparseGrid<NodeBlock> grid_;
  geometry::GridCursor<NodeBlock> nodes_;
  std::vector<Goal> goals_;
  std::vector<Offset> sphere_;
  std::priority_queue<Open> queue_;
  int support_vox_;
};

}  // namespace

Plan FindPath(const VoxelMap& map, const VoxelKey& start, std::span<const VoxelKey> goals,
              const GraphRules& rules, const PlannerConfig& config) {
  return Search(map, goals, rules, config).Run(start);
}

std::optional<VoxelKey> StartVoxel(const VoxelMap& map, const Vector3d& p_world_foot) {
  const double voxel_m = map.config().voxel_m;
  const int reach = CellsFloor(0.5, voxel_m);  // chosen: an agent is never farther from its floor
  const Vector3d p_start = p_world_foot + Vector3d(0, 0, voxel_m);
  const VoxelKey center = geometry::KeyOf(p_start, voxel_m);
  std::optional<VoxelKey> best;
  double best_distance = kInfinity;
  map.ForEachInBox(
      {center.x - reach, center.y - reach, center.z - reach},
      {center.x + reach, center.y + reach, center.z + reach},
      [&](const VoxelKey& key, const Voxel& voxel) {
        if (!IsPathable(voxel.state) || IsSurface(voxel.state)) return;
        const double d = (CenterOf(key, voxel_m) - p_start).norm();
        if (d < best_distance - 1e-9 || (d < best_distance + 1e-9 && best && key < *best)) {
          best = key;
          best_distance = d;
        }
      });
  return best;
}

std::optional<int> SupportZ(const VoxelMap& map, const VoxelKey& key) {
  if (IsSurface(map.StateAt(key))) return key.z;
  VoxelKey support;
  if (!map.FindSupport(key, &support)) return std::nullopt;
  return support.z;
}

}  // namespace crossnav::planner
