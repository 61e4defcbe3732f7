// SPDX-License-Identifier: MIT
#include "crossnav/policy/ground_frontiers.h"

#include <algorithm>
#include <array>
#include <map>

#include "crossnav/policy/clusters.h"

namespace crossnav::policy {
namespace {

constexpr std::array<std::size_t, 4> kStraight = {6, 1, 4, 3};  // of kStepSides: +x, -x, +y, -y
static_assert(planner::kStepSides[6][0] == 1 && planner::kStepSides[1][0] == -1 &&
              planner::kStepSides[4][1] == 1 && planner::kStepSides[3][1] == -1);

}  // namespace

bool IsGroundFrontier(const planner::GroundMap& ground, const VoxelKey& key, VoxelKey* beyond) {
  return IsGroundFrontier(ground, ground.places().IndexOf(key), beyond);
}

bool IsGroundFrontier(const planner::GroundMap& ground, std::int32_t place, VoxelKey* beyond) {
  planner::GroundPlaces& places = ground.places();
  const unsigned unseen = places.StepsFrom(ground, place).unseen;
  if (unseen == 0) return false;
  const VoxelKey key = places.KeyAt(place);
  for (const std::size_t side : kStraight) {
    if ((unseen >> side & 1) == 0) continue;
    const auto& [dx, dy] = planner::kStepSides[side];
    *beyond = {key.x + dx, key.y + dy, key.z};
    return true;
  }
  return false;
}

Candidate GroundFrontierAround(const planner::GroundMap& ground, const VoxelKey& seed,
                               std::set<VoxelKey>* visited) {
  std::map<VoxelKey, VoxelKey> border;  // place -> unseen column beside it
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
