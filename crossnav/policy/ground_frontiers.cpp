// SPDX-License-Identifier: MIT
#include "crossnav/policy/ground_frontiers.h"

#include <algorithm>
#include <array>
#include <map>

#include "crossnav/policy/clusters.h"

namespace crossnav::policy {
namespace {

constexpr std::array<std::array<int, 2>, 4> kSides = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

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
