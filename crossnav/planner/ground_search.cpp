// SPDX-License-Identifier: MIT
#include "crossnav/planner/ground_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::planner {
namespace {

constexpr int kBridge_vox = 4;  // chosen: the deepest tread
constexpr int kEdge_vox = 2;    // chosen: less is a doorstep
constexpr std::array<std::array<int, 2>, 8> kSteps = {
    {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};

}  // namespace

double GroundEdgeCost(const VoxelKey& from, const VoxelKey& to, Clearance room, int climb,
                      const PlannerConfig& config) {
  const double length = geometry::VoxelDistance(from, to);
  const double high = std::abs(to.z - from.z) >= climb ? config.high_step_cost : 0;
  switch (room) {
    case Clearance::kFree:
      return length + high;
    case Clearance::kTight:
      return (length + high) * config.inflated_cost_factor;
    case Clearance::kTouch:
    case Clearance::kPinch:
      break;
  }
  return (length + high) * config.touch_cost_factor;
}

GroundSearch::GroundSearch(const GroundMap& ground, const PlannerConfig& config,
                           const VoxelKey& start, const GroundRules& rules)
    : ground_(ground), config_(config), rules_(rules), table_(1024, -1) {
  nodes_.reserve(1024);
  const std::int32_t first = NodeOf(start);
  nodes_[static_cast<std::size_t>(first)].cost = 0;
  LookUpRoom(nodes_[static_cast<std::size_t>(first)]);
  queue_.push_back({0, start, first});
}

std::int32_t GroundSearch::Find(const VoxelKey& key) const {
  const std::size_t mask = table_.size() - 1;
  for (std::size_t at = geometry::VoxelKeyHash()(key) & mask;; at = (at + 1) & mask) {
    const std::int32_t node = table_[at];
    if (node < 0 || nodes_[static_cast<std::size_t>(node)].key == key) return node;
  }
}

void GroundSearch::Grow() {
  std::vector<std::int32_t> table(table_.size() * 2, -1);
  const std::size_t mask = table.size() - 1;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    std::size_t at = geometry::VoxelKeyHash()(nodes_[i].key) & mask;
    while (table[at] >= 0) at = (at + 1) & mask;
    table[at] = static_cast<std::int32_t>(i);
  }
  table_ = std::move(table);
}

std::int32_t GroundSearch::NodeOf(const VoxelKey& key) {
  const std::int32_t known = Find(key);
  if (known >= 0) return known;
  if (2 * nodes_.size() >= table_.size()) Grow();
  const std::size_t mask = table_.size() - 1;
  std::size_t at = geometry::VoxelKeyHash()(key) & mask;
  while (table_[at] >= 0) at = (at + 1) & mask;
  table_[at] = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back({key, 1e18, -1, -1, false});
  return table_[at];
}

void GroundSearch::LookUpRoom(Node& node) const {
  if (node.clearance < 0) node.clearance = static_cast<std::int8_t>(ground_.ClearanceOf(node.key));
}

std::optional<VoxelKey> GroundSearch::Next() {
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end());
    const Open open = queue_.back();
    queue_.pop_back();
    Node& node = nodes_[static_cast<std::size_t>(open.node)];
    if (node.is_closed) continue;
    node.is_closed = true;
    last_cost_ = open.cost;
    Expand(open.node);
    return open.key;
  }
  return std::nullopt;
}

void GroundSearch::Expand(std::int32_t from_index) {
  const Node from = nodes_[static_cast<std::size_t>(from_index)];
  for (const auto& step : kSteps) {
    int z = 0;
    switch (ground_.SideOf(from.key, step[0], step[1], &z)) {
      case Side::kBlocked:
        break;
      case Side::kGround: {
        const VoxelKey to{from.key.x + step[0], from.key.y + step[1], z};
        if (!IsEdge(from.key, to)) Relax(from_index, to, 1);
        break;
      }
      case Side::kUnknown:
      case Side::kDrop: {
        const bool is_diagonal = step[0] != 0 && step[1] != 0;
        const auto to =
            ground_.Bridge(from.key, step[0], step[1], is_diagonal ? kBridge_vox - 1 : kBridge_vox);
        if (to) Relax(from_index, *to, config_.bridge_cost_factor);
        break;
      }
    }
  }
}

/// The front of a seat, not a tread: the foot that steps onto it meets the seat behind it, which is
/// too high. A tread is two columns deep, so that two steps of a stair are never that near.
bool GroundSearch::IsEdge(const VoxelKey& from, const VoxelKey& to) const {
  if (to.z - from.z < kEdge_vox) return false;
  const auto is_high = [&](int dx, int dy) {
    const auto z = ground_.StandingNear(to.x + dx, to.y + dy, to.z, ground_.climb());
    return z && *z - from.z > ground_.climb();
  };
  const int dx = to.x - from.x, dy = to.y - from.y;
  return is_high(dx, dy) || (dx != 0 && dy != 0 && (is_high(dx, 0) || is_high(0, dy)));
}

void GroundSearch::Relax(std::int32_t from_index, const VoxelKey& to, double factor) {
  const Node from = nodes_[static_cast<std::size_t>(from_index)];
  if (rules_.level && !rules_.level->Contains(to.z - 1)) return;
  const std::int32_t index = NodeOf(to);
  Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.is_closed) return;
  LookUpRoom(node);
  const auto room = static_cast<Clearance>(node.clearance);
  // A start in a pinch may leave it; nothing else leads in, or what can be reached would depend on
  // where one happens to stand.
  const bool is_leaving = static_cast<Clearance>(from.clearance) == Clearance::kPinch;
  if (room == Clearance::kPinch && !is_leaving) return;
  const double cost =
      from.cost + factor * GroundEdgeCost(from.key, to, room, ground_.climb(), config_);
  if (cost >= node.cost - 1e-12) return;
  node.cost = cost;
  node.parent = from_index;
  queue_.push_back({cost, to, index});
  std::push_heap(queue_.begin(), queue_.end());
}

std::optional<double> GroundSearch::CostOf(const VoxelKey& key) const {
  const std::int32_t index = Find(key);
  if (index < 0 || !nodes_[static_cast<std::size_t>(index)].is_closed) return std::nullopt;
  return nodes_[static_cast<std::size_t>(index)].cost;
}

std::vector<VoxelKey> GroundSearch::PathTo(const VoxelKey& key) const {
  std::vector<VoxelKey> path;
  for (std::int32_t at = Find(key); at >= 0; at = nodes_[static_cast<std::size_t>(at)].parent)
    path.push_back(nodes_[static_cast<std::size_t>(at)].key);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace crossnav::planner
