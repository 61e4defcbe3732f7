// SPDX-License-Identifier: MIT
#include "crossnav/policy/glance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "crossnav/core/cells.h"

namespace crossnav::policy {

using geometry::VoxelKey;

namespace {

constexpr double kSector_rad = 2 * M_PI / kGlanceSectors;
constexpr int kSectorRays = 4;     // chosen: of a sector, half a metre apart at the end
constexpr double kPlace_m = 1.0;   // chosen: four steps
constexpr double kTurn_m2 = 0.05;  // chosen: of two headings with equal area, the nearer

using PerSector = std::array<double, kGlanceSectors>;

int SectorOf(double yaw_rad) {
  const int sector = static_cast<int>(std::lround(yaw_rad / kSector_rad)) % kGlanceSectors;
  return sector < 0 ? sector + kGlanceSectors : sector;
}

/// Calls `visit` for the sectors that a picture along `heading` shows whole.
template <class F>
void ForEachShown(int heading, double hfov_rad, F&& visit) {
  const int beside =
      std::min(static_cast<int>((0.5 * hfov_rad + 1e-9) / kSector_rad), (kGlanceSectors - 1) / 2);
  for (int d = -beside; d <= beside; ++d) visit((heading + d + kGlanceSectors) % kGlanceSectors);
}

/// Unseen ground along one ray of `width_rad` [m2].
double UnseenAlong(const planner::GroundMap& ground, const VoxelKey& place, double angle_rad,
                   double width_rad, int reach_vox) {
  const double cos = std::cos(angle_rad), sin = std::sin(angle_rad);
  double unseen_vox2 = 0;
  for (int r = 1; r <= reach_vox; ++r) {
    int z = 0;
    const planner::StepOutcome outcome = ground.OutcomeOf(
        place, static_cast<int>(std::lround(r * cos)), static_cast<int>(std::lround(r * sin)), &z);
    if (outcome == planner::StepOutcome::kUnknown) {
      unseen_vox2 += r * width_rad;
    } else if (unseen_vox2 > 0 || outcome != planner::StepOutcome::kGround) {
      break;
    }
  }
  return unseen_vox2 * ground.voxel_m() * ground.voxel_m();
}

}  // namespace

void LookedAlong::Add(const AgentPose& pose, double hfov_rad) {
  std::uint16_t& sectors = sectors_[geometry::KeyOf(pose.p_world, kPlace_m)];
  ForEachShown(SectorOf(pose.yaw_rad), hfov_rad,
               [&](int sector) { sectors = static_cast<std::uint16_t>(sectors | 1U << sector); });
}

bool LookedAlong::Has(const Vector3d& p_world, int sector) const {
  const auto it = sectors_.find(geometry::KeyOf(p_world, kPlace_m));
  return it != sectors_.end() && (it->second >> sector & 1U) != 0;
}

std::optional<double> GlanceHeading(const planner::GroundMap& ground, const VoxelKey& place,
                                    const AgentPose& agent, double hfov_rad,
                                    const LookedAlong& looked, const ExploreConfig& config) {
  const int reach = CellsFloor(config.glance_range_m, ground.voxel_m());
  PerSector unseen_m2{};
  for (int sector = 0; sector < kGlanceSectors; ++sector) {
    if (looked.Has(agent.p_world, sector)) continue;
    for (int ray = 0; ray < kSectorRays; ++ray) {
      const double angle_rad = (sector + (ray + 0.5) / kSectorRays - 0.5) * kSector_rad;
      unseen_m2[static_cast<std::size_t>(sector)] +=
          UnseenAlong(ground, place, angle_rad, kSector_rad / kSectorRays, reach);
    }
  }
  const int own = SectorOf(agent.yaw_rad);
  int best = own;
  double best_m2 = config.glance_m2;
  for (int heading = 0; heading < kGlanceSectors; ++heading) {
    const int off = std::abs(heading - own);
    double shown_m2 = -kTurn_m2 * std::min(off, kGlanceSectors - off);
    ForEachShown(heading, hfov_rad,
                 [&](int sector) { shown_m2 += unseen_m2[static_cast<std::size_t>(sector)]; });
    if (shown_m2 <= best_m2) continue;
    best = heading;
    best_m2 = shown_m2;
  }
  if (best == own) return std::nullopt;
  return best * kSector_rad;
}

}  // namespace crossnav::policy
