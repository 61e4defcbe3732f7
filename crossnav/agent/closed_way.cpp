// SPDX-License-Identifier: MIT
#include "crossnav/agent/closed_way.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "crossnav/agent/shared_parts.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/policy/approach.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using planner::GroundSearch;
using policy::CandidateKind;

namespace {

constexpr double kBar_m = 1.0;     // chosen: a leaf, and room for the body on both sides
constexpr double kThrough = 3;     // chosen: price of a metre through the door
constexpr double kLookAt_m = 1.0;  // chosen: above the ground, the middle of a door
constexpr double kAside_m = 0.8;   // chosen: the width of a door
constexpr int kMostTries = 4;      // chosen: looks in vain
constexpr int kMostDoors = 100;    // chosen: more than a house has
constexpr int kDoor_vox = 3;       // chosen: of the height of a leaf, in one column or more
constexpr int kCellBits = 2;       // chosen: cells of 0.4 m

/// Columns of the places that answer to "door" about as well as the best one.
class Doors {
 public:
  explicit Doors(const Situation& now)
      : height_vox_(static_cast<int>(std::lround(2 * kLookAt_m / now.config.map.voxel_m))) {
    if (now.world.full.door.empty()) return;
    memory::QueryConfig query = now.config.query;
    query.top_k = kMostDoors;
    const auto places = memory::Query(now.world.memory, now.world.full.door, query);
    double best = -1;
    for (const memory::MemoryCluster& place : places) best = std::max(best, place.similarity);
    for (const memory::MemoryCluster& place : places)
      if (place.similarity >= best - now.config.policy.poi.similarity_slack)
        for (const VoxelKey& key : place.voxels) heights_[{key.x, key.y, 0}].push_back(key.z);
  }

  /// Whether a door is on the straight line between two places.
  bool IsBetween(const VoxelKey& a, const VoxelKey& b) const {
    const int steps = std::max({1, std::abs(b.x - a.x), std::abs(b.y - a.y)});
    std::ptrdiff_t count = 0;
    for (int i = 0; i <= steps; ++i) {
      const auto column =
          heights_.find({a.x + (b.x - a.x) * i / steps, a.y + (b.y - a.y) * i / steps, 0});
      if (column == heights_.end()) continue;
      count += std::count_if(column->second.begin(), column->second.end(),
                             [&](int z) { return z >= a.z && z < a.z + height_vox_; });
    }
    return count >= kDoor_vox;
  }

 private:
  int height_vox_;
  std::unordered_map<VoxelKey, std::vector<int>, geometry::VoxelKeyHash> heights_;  // z = 0
};

/// Ground behind doors, by its cost to the place: the best of each cell.
class GroundBehind {
 public:
  GroundBehind(const Situation& now, const HistoryPoi& poi) : now_(now) {
    const auto& approach = now.config.policy.approach;
    const policy::ViewTest view(now.world.map, poi.voxels, 2 * approach.range_m, approach,
                                now.config.sensor.camera_height_m);
    const ObjectStorey storey(now, poi.voxels, poi.p_center_world);
    const VoxelKey &lo = view.lo(), &hi = view.hi();
    for (int x = lo.x; x <= hi.x; ++x)
      for (int y = lo.y; y <= hi.y; ++y)
        for (int z = lo.z; z <= hi.z; ++z)
          if (const VoxelKey key{x, y, z};
              now.world.ground.IsStanding(key) && !costs_.contains(key) &&
              storey.Has(FootOf(key, now.config.map.voxel_m)) && view.IsView(key))
            AddAround(key);
    for (const auto& [key, cost] : costs_) {
      auto [it, is_new] = cells_.try_emplace(CellOf(key), key, cost);
      if (!is_new && std::pair(cost, key) < std::pair(it->second.second, it->second.first))
        it->second = {key, cost};
    }
  }

  bool IsEmpty() const { return cells_.empty(); }
  bool Has(const VoxelKey& key) const { return costs_.contains(key); }

  /// The ground behind a door beside `key` with the least price [voxels].
  std::optional<std::pair<VoxelKey, double>> Best(const Doors& doors, const VoxelKey& key) const {
    const double reach_vox = kBar_m / now_.config.map.voxel_m;
    const int cells = static_cast<int>(std::ceil(reach_vox / (1 << kCellBits)));
    const VoxelKey at = CellOf(key);
    std::optional<std::pair<VoxelKey, double>> best;
    for (int dx = -cells; dx <= cells; ++dx)
      for (int dy = -cells; dy <= cells; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto it = cells_.find({at.x + dx, at.y + dy, at.z + dz});
          if (it == cells_.end()) continue;
          const auto& [behind, cost] = it->second;
          const double gap_vox = std::hypot(behind.x - key.x, behind.y - key.y);
          if (gap_vox > reach_vox || std::abs(behind.z - key.z) > now_.world.ground.climb())
            continue;
          const double price = cost + kThrough * gap_vox;
          if (best && std::pair(best->second, best->first) <= std::pair(price, behind)) continue;
          if (doors.IsBetween(key, behind)) best = {behind, price};
        }
    return best;
  }

 private:
  static VoxelKey CellOf(const VoxelKey& key) {
    return {key.x >> kCellBits, key.y >> kCellBits, key.z >> kCellBits};
  }

  void AddAround(const VoxelKey& view) {
    GroundSearch search(now_.world.ground, now_.config.planner, view, RulesOf(now_));
    while (const auto place = search.Next()) costs_.try_emplace(*place, search.cost());
  }

  const Situation& now_;
  std::unordered_map<VoxelKey, double, geometry::VoxelKeyHash> costs_;
  std::unordered_map<VoxelKey, std::pair<VoxelKey, double>, geometry::VoxelKeyHash> cells_;
};

std::optional<GroundTarget> WayTo(const Situation& now, const VoxelKey& start,
                                  const HistoryPoi& poi) {
  const GroundBehind ground(now, poi);
  if (ground.IsEmpty() || ground.Has(start)) return std::nullopt;
  const Doors doors(now);
  const double voxel_m = now.config.map.voxel_m;
  GroundSearch search(now.world.ground, now.config.planner, start, RulesOf(now));
  std::optional<VoxelKey> end;
  VoxelKey behind;
  double best = 0;
  while (const auto place = search.Next()) {
    if (end && search.cost() >= best) break;
    const auto across = ground.Best(doors, *place);
    if (!across || (end && search.cost() + across->second >= best)) continue;
    const Vector3d p_focus = CenterOf(across->first, voxel_m) + Vector3d(0, 0, kLookAt_m);
    if (IsSpent(now.goal.full.attempts, CandidateKind::kClosedWay, p_focus, kAside_m,
                now.config.policy.explore.max_choices))
      continue;
    end = place;
    behind = across->first;
    best = search.cost() + across->second;
  }
  if (!end) return std::nullopt;
  GroundTarget target;
  target.path = search.PathTo(*end);
  target.cost_m = search.CostOf(*end).value_or(0) * voxel_m;
  target.score_m = best * voxel_m;
  target.candidate.kind = CandidateKind::kClosedWay;
  target.candidate.p_focus_world = CenterOf(behind, voxel_m) + Vector3d(0, 0, kLookAt_m);
  target.candidate.standing = {*end};
  return target;
}

}  // namespace

void LearnDoors(perception::DenseEncoder& encoder, World* world) {
  if (!world->has_loaded_objects || !world->full.door.empty()) return;
  if (auto vector = encoder.EncodeText("door")) world->full.door = std::move(*vector);
}

std::optional<GroundTarget> ChooseClosedWay(
    const Situation& now, const VoxelKey& start,
    const std::vector<std::optional<int>>& unreachable_steps) {
  if (!now.world.has_loaded_objects) return std::nullopt;
  const auto tries = std::count_if(
      now.goal.full.attempts.begin(), now.goal.full.attempts.end(), [](const Attempt& attempt) {
        return attempt.kind == CandidateKind::kClosedWay && attempt.ending == Ending::kNotOpened;
      });
  if (tries >= kMostTries) return std::nullopt;
  std::optional<GroundTarget> best;
  for (std::size_t i = 0; i < unreachable_steps.size(); ++i) {
    const HistoryPoi& poi = now.goal.history[i];
    if (!unreachable_steps[i] || !IsWorthGoingTo(now, poi)) continue;
    auto target = WayTo(now, start, poi);
    if (target && (!best || target->score_m < best->score_m)) best = std::move(target);
  }
  return best;
}

bool IsWayClosed(const Situation& now) {
  return std::any_of(now.goal.history.begin(), now.goal.history.end(), [&](const HistoryPoi& poi) {
    return poi.unreachable_step && IsWorthGoingTo(now, poi);
  });
}

}  // namespace crossnav::agent
