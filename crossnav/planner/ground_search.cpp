// SPDX-License-Identifier: MIT
#include "crossnav/planner/ground_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::planner {

double GroundEdgeCost(const VoxelKey& from, const VoxelKey& to, Clearance room, int climb,
                      const PlannerConfig& config) {
  const double length = geometry::VoxelDistance(from, to);
  const double high = std::abs(to.z - from.z) >= climb ? config.high_step_cost : 0;
  switch (room) {
    case Clearance::kFree:
      return length + high;
    case Clearance::kTight:
      return (length + high) * config.tight_cost_factor;
    case Clearance::kTouch:
    case Clearance::kPinch:
      break;
  }
  return (length + high) * config.touch_cost_factor;
}

GroundSearch::GroundSearch(const GroundMap& ground, const PlannerConfig& config,
                           const VoxelKey& start, const GroundRules& rules)
    : ground_(&ground), config_(&config), rules_(rules) {
  const std::int32_t first = ground.places().IndexOf(start);
  At(first).cost = 0;
  queue_.push_back({0, start, first});
}

std::optional<VoxelKey> GroundSearch::Next() {
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end());
    const Open open = queue_.back();
    queue_.pop_back();
    Node& node = At(open.place);
    if (node.is_closed) continue;
    node.is_closed = true;
    last_cost_ = open.cost;
    Expand(open.place);
    return open.key;
  }
  return std::nullopt;
}

namespace {

/// Two steps in one over level ground: along an axis and along a diagonal, in either order. Indices
/// of kStepSides.
struct Oblique {
  std::size_t axis, diagonal;
};
constexpr std::array<Oblique, 8> kObliques = {
    {{1, 0}, {3, 0}, {1, 2}, {4, 2}, {6, 5}, {3, 5}, {6, 7}, {4, 7}}};

bool IsPlain(const GroundPlaces::Steps& steps, std::size_t side) {
  const std::uint8_t odd = steps.bridges | steps.one_way | steps.fronts;
  return steps.to[side] >= 0 && (odd >> side & 1) == 0;
}

bool IsOblique(const VoxelKey& from, const VoxelKey& to) {
  const int dx = std::abs(to.x - from.x), dy = std::abs(to.y - from.y);
  return from.z == to.z && std::min(dx, dy) == 1 && std::max(dx, dy) == 2;
}

/// The place of an oblique step's path that a step along an axis leads to.
VoxelKey Between(const VoxelKey& from, const VoxelKey& to) {
  return {from.x + (to.x - from.x) / 2, from.y + (to.y - from.y) / 2, from.z};
}

}  // namespace

void GroundSearch::Expand(std::int32_t from_place) {
  GroundPlaces& places = ground_->places();
  const GroundPlaces::Steps steps = places.StepsFrom(*ground_, from_place);
  // A start in a pinch may leave it. No other step leads into a pinch: reachability must not depend
  // on the start.
  const From from{from_place, places.KeyAt(from_place), At(from_place).cost,
                  places.RoomAt(*ground_, from_place) == Clearance::kPinch};
  for (std::size_t i = 0; i < steps.to.size(); ++i) {
    if (steps.to[i] < 0 || At(steps.to[i]).is_closed) continue;
    const auto has = [i](std::uint8_t bits) { return (bits >> i & 1) != 0; };
    if (has(steps.fronts) && !rules_.may_step_on_seats) continue;
    const double risk_m = (has(steps.one_way) ? config_->one_way_m : 0) +
                          (has(steps.fronts) ? config_->doubtful_m : 0);
    Relax(from, steps.to[i],
          {has(steps.bridges) ? config_->bridge_cost_factor : 1, risk_m / ground_->voxel_m()});
  }
  ExpandOblique(from, steps);
}

/// Eight directions alone make paths up to 8 % too long.
void GroundSearch::ExpandOblique(const From& from, const GroundPlaces::Steps& steps) {
  GroundPlaces& places = ground_->places();
  const auto is_level = [&](std::int32_t place) { return places.KeyAt(place).z == from.key.z; };
  for (const auto [axis, diagonal] : kObliques) {
    if (!IsPlain(steps, axis) || !IsPlain(steps, diagonal)) continue;
    const std::int32_t beside = steps.to[axis], ahead = steps.to[diagonal];
    if (!is_level(beside) || !is_level(ahead)) continue;
    const GroundPlaces::Steps from_beside = places.StepsFrom(*ground_, beside);
    if (!IsPlain(from_beside, diagonal)) continue;
    const std::int32_t to = from_beside.to[diagonal];
    if (!is_level(to) || At(to).is_closed) continue;
    if (from.cost + geometry::VoxelDistance(from.key, places.KeyAt(to)) >= At(to).cost - 1e-12)
      continue;
    const GroundPlaces::Steps from_ahead = places.StepsFrom(*ground_, ahead);
    if (!IsPlain(from_ahead, axis) || from_ahead.to[axis] != to) continue;
    const Clearance least = std::max({places.RoomAt(*ground_, beside),
                                      places.RoomAt(*ground_, ahead), places.RoomAt(*ground_, to)});
    if (least == Clearance::kPinch) continue;
    RelaxTo(from, to,
            GroundEdgeCost(from.key, places.KeyAt(to), least, ground_->climb(), *config_));
  }
}

void GroundSearch::Relax(const From& from, std::int32_t to, const Price& price) {
  const VoxelKey key = ground_->places().KeyAt(to);
  if (rules_.level && !rules_.level->Contains(key.z - 1)) return;
  // No edge costs less than its length.
  if (from.cost + geometry::VoxelDistance(from.key, key) >= At(to).cost - 1e-12) return;
  const Clearance room = ground_->places().RoomAt(*ground_, to);
  const bool is_squeeze = room == Clearance::kPinch && !from.is_in_pinch;
  if (is_squeeze && !rules_.may_squeeze) return;
  const double edge = GroundEdgeCost(from.key, key, room, ground_->climb(), *config_);
  RelaxTo(from, to,
          price.factor * edge + price.added +
              (is_squeeze ? config_->doubtful_m / ground_->voxel_m() : 0));
}

void GroundSearch::RelaxTo(const From& from, std::int32_t to, double edge) {
  const double cost = from.cost + edge;
  Node& node = At(to);
  if (cost >= node.cost - 1e-12) return;
  node.cost = cost;
  node.parent = from.place;
  queue_.push_back({cost, ground_->places().KeyAt(to), to});
  std::push_heap(queue_.begin(), queue_.end());
}

std::optional<double> GroundSearch::CostOf(const VoxelKey& key) const {
  const std::int32_t place = ground_->places().Find(key);
  if (place < 0 || static_cast<std::size_t>(place) >= nodes_.size()) return std::nullopt;
  const Node& node = nodes_[static_cast<std::size_t>(place)];
  return node.is_closed ? std::optional(node.cost) : std::nullopt;
}

std::vector<VoxelKey> GroundSearch::PathTo(const VoxelKey& key) const {
  std::vector<VoxelKey> path;
  if (!CostOf(key)) return path;
  for (std::int32_t at = ground_->places().Find(key); at >= 0;
       at = nodes_[static_cast<std::size_t>(at)].parent) {
    const VoxelKey& here = ground_->places().KeyAt(at);
    if (!path.empty() && IsOblique(here, path.back())) path.push_back(Between(here, path.back()));
    path.push_back(here);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace crossnav::planner
