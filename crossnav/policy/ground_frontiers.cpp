// SPDX-License-Identifier: MIT
#include "crossnav/policy/ground_frontiers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "crossnav/core/cells.h"
#include "crossnav/policy/clusters.h"

namespace crossnav::policy {
namespace {

constexpr std::array<std::array<int, 2>, 4> kSides = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
constexpr int kRays = 48;       // chosen: half a metre apart at the end
constexpr int kBefore_vox = 4;  // chosen: of seen ground before the unseen begins

}  // namespace

bool IsGroundFrontier(const planner::GroundMap& ground, const VoxelKey& key, VoxelKey* beyond) {
  for (const auto& side : kSides) {
    int z = 0;
    if (ground.SideOf(key, side[0], side[1], &z) != planner::Side::kUnknown) continue;
    *beyond = {key.x + side[0], key.y + side[1], key.z};
    return true;
  }
  return false;
}

double UnseenBeyond(const planner::GroundMap& ground, const VoxelKey& place, double range_m) {
  constexpr double kRay_rad = 2 * M_PI / kRays;
  const int reach = CellsFloor(range_m, ground.voxel_m());
  double unseen_vox2 = 0;
  for (int ray = 0; ray < kRays; ++ray) {
    const double cos = std::cos(ray * kRay_rad), sin = std::sin(ray * kRay_rad);
    bool is_beyond = false;
    for (int r = 1; r <= reach; ++r) {
      int z = 0;
      const planner::Side side = ground.SideOf(place, static_cast<int>(std::lround(r * cos)),
                                               static_cast<int>(std::lround(r * sin)), &z);
      if (side == planner::Side::kUnknown) {
        is_beyond = true;
        unseen_vox2 += r * kRay_rad;
      } else if (is_beyond || side != planner::Side::kGround || r > kBefore_vox) {
        break;
      }
    }
  }
  return unseen_vox2 * ground.voxel_m() * ground.voxel_m();
}

Candidate GroundFrontierAround(const planner::GroundMap& ground, const VoxelKey& seed,
                               std::set<VoxelKey>* visited) {
  std::map<VoxelKey, VoxelKey> border;  // place -> what it borders on
  std::vector<VoxelKey> stack;
  const auto visit = [&](const VoxelKey& key) {
    VoxelKey beyond;
    if (visited->contains(key) || !IsGroundFrontier(ground, key, &beyond)) return;
    visited->insert(key);
    border.emplace(key, beyond);
    stack.push_back(key);
  };
  visit(seed);
  while (!stack.empty()) {
    const VoxelKey key = stack.back();
    stack.pop_back();
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const auto z = ground.StandingNear(key.x + dx, key.y + dy, key.z, ground.climb());
        if (z) visit({key.x + dx, key.y + dy, *z});
      }
  }
  Candidate candidate;
  candidate.kind = CandidateKind::kTraversableFrontier;
  for (const auto& [standing, beyond] : border) {
    candidate.standing.push_back(standing);
    candidate.beyond.push_back(beyond);
  }
  candidate.size = static_cast<int>(candidate.standing.size());
  candidate.p_focus_world = CentroidOf(candidate.beyond, ground.voxel_m());
  return candidate;
}

}  // namespace crossnav::policy
