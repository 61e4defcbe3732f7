// SPDX-License-Identifier: MIT
#include "crossnav/policy/frontier_worth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "crossnav/core/cells.h"

namespace crossnav::policy {

using geometry::VoxelKey;

namespace {

constexpr int kRays = 48;        // chosen: half a metre apart at the end
constexpr int kBefore_vox = 4;   // chosen: of seen ground before the unseen begins
constexpr double kCell_m = 0.8;  // chosen: the size of a piece of furniture
constexpr int kReach = 2;        // chosen: cells to each side

VoxelKey CellOf(const Vector3d& p_world) {
  return geometry::KeyOf(p_world, kCell_m);
}

}  // namespace

double UnseenBeyond(const planner::GroundMap& ground, const VoxelKey& place, double range_m) {
  constexpr double kRay_rad = 2 * M_PI / kRays;
  const int reach = CellsFloor(range_m, ground.voxel_m());
  double unseen_vox2 = 0;
  for (int ray = 0; ray < kRays; ++ray) {
    const double cos = std::cos(ray * kRay_rad), sin = std::sin(ray * kRay_rad);
    bool is_beyond = false;
    for (int r = 1; r <= reach; ++r) {
      int z = 0;
      const planner::StepOutcome outcome =
          ground.OutcomeOf(place, static_cast<int>(std::lround(r * cos)),
                           static_cast<int>(std::lround(r * sin)), &z);
      if (outcome == planner::StepOutcome::kUnknown) {
        is_beyond = true;
        unseen_vox2 += r * kRay_rad;
      } else if (is_beyond || outcome != planner::StepOutcome::kGround || r > kBefore_vox) {
        break;
      }
    }
  }
  return unseen_vox2 * ground.voxel_m() * ground.voxel_m();
}

void Relevancy::Refresh(const memory::SemanticMemory& memory, std::span<const float> similarity) {
  best_.clear();
  if (similarity.empty()) return;
  std::vector<float> sorted(similarity.begin(), similarity.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const float median = *middle;
  const float span = std::max(*std::max_element(sorted.begin(), sorted.end()) - median, 1e-3F);
  for (std::size_t row = 0; row < similarity.size(); ++row) {
    const Vector3d p_world = CenterOf(memory.Keys()[row], memory.VoxelSize());
    float& best = best_[CellOf(p_world)];
    best = std::max(best, (similarity[row] - median) / span);
  }
}

double Relevancy::Around(const Vector3d& p_world) const {
  const VoxelKey cell = CellOf(p_world);
  double sum = 0;
  int count = 0;
  for (int dz = 0; dz <= 1; ++dz)
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const auto it = best_.find(cell + VoxelKey{dx, dy, dz});
        if (it == best_.end()) continue;
        sum += it->second;
        ++count;
      }
  return count == 0 ? 0 : sum / count;
}

double FrontierWorth(const planner::GroundMap& ground, const VoxelKey& place,
                     const Relevancy& relevancy, const ExploreConfig& config) {
  if (config.scoring == "nearest") return 1;
  double worth = UnseenBeyond(ground, place, config.view_range_m) / config.room_m2;
  if (config.scoring == "semantic")
    worth *= 1 + relevancy.Around(CenterOf(place, ground.voxel_m()));
  return std::clamp(worth, config.least_share, 1.0);
}

}  // namespace crossnav::policy
