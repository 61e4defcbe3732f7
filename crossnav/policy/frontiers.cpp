// SPDX-License-Identifier: MIT
#include "crossnav/policy/frontiers.h"

#include <algorithm>
#include <array>
#include <map>

#include "crossnav/core/cells.h"
#include "crossnav/policy/clusters.h"

namespace crossnav::policy {
namespace {

using geometry::Voxel;
using geometry::VoxelState;
using Cursor = VoxelMap::Cursor;

constexpr std::array<VoxelKey, 4> kSides = {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}};

/// A surface seen from below only: the ceiling of the storey underneath, 0.2 to 0.3 m below a
/// floor. It may lie on a voxel border and fill two layers.
bool IsCeilingBelow(Cursor& map, const VoxelKey& key) {
  VoxelKey below = key;
  while (key.z - below.z < 3 && IsSurface(map.At(below).state)) --below.z;
  const VoxelState state = map.At(below).state;
  return below != key && state != VoxelState::kUnknown && !IsSurface(state);
}

/// Nothing observed at `key` nor within +-`reach_vox` in its column; observations of the storey
/// underneath do not count.
bool IsGenuineUnknown(Cursor& map, const VoxelKey& key, int reach_vox) {
  for (int dz = 0; dz <= reach_vox; ++dz) {
    if (map.At({key.x, key.y, key.z + dz}).state != VoxelState::kUnknown) return false;
  }
  for (int dz = 1; dz <= reach_vox; ++dz) {
    const VoxelKey below{key.x, key.y, key.z - dz};
    if (map.At(below).state == VoxelState::kUnknown) continue;
    return IsCeilingBelow(map, below);
  }
  return true;
}

/// Runs `visit(key)` for each free standing voxel of the level: TRAVERSABLE, not inflated, directly
/// on its support. The higher layers of the same column say nothing new about a frontier.
template <class F>
void ForEachStanding(const VoxelMap& map, const planner::LevelBand& level, const F& visit) {
  Cursor cursor(map);
  map.ForEachInSlab(level.min_z + 1, level.max_z + 1, [&](const VoxelKey& key, const Voxel& voxel) {
    if (voxel.state != VoxelState::kTraversable || voxel.is_inflated) return;
    if (IsSurface(cursor.At({key.x, key.y, key.z - 1}).state) && level.Contains(key.z - 1))
      visit(key);
  });
}

/// Air beside the level that nothing supports, rejected stairs, or ground below the level's band.
bool IsDrop(const VoxelMap& map, Cursor& cursor, const VoxelKey& key,
            const planner::LevelBand& level) {
  const VoxelState state = cursor.At(key).state;
  if (state == VoxelState::kTraversableFake) return true;
  if (cursor.At({key.x, key.y, key.z - 1}).state == VoxelState::kFakeStair) return true;
  if (!IsPathable(state) || IsSurface(state)) return false;
  VoxelKey support;
  return map.FindSupport(key, &support) && support.z < level.min_z;
}

/// Standing voxel -> unknown voxel beside it.
using Border = std::map<VoxelKey, VoxelKey>;

std::vector<Candidate> CandidatesOf(const Border& border, CandidateKind kind, int min_cluster,
                                    double voxel_m) {
  std::vector<VoxelKey> keys;
  for (const auto& [standing, beyond] : border) keys.push_back(standing);
  std::vector<Candidate> candidates;
  for (auto& cluster : ConnectedClusters(std::move(keys))) {
    if (static_cast<int>(cluster.size()) < min_cluster) continue;
    Candidate candidate;
    candidate.kind = kind;
    candidate.size = static_cast<int>(cluster.size());
    for (const VoxelKey& key : cluster) candidate.beyond.push_back(border.at(key));
    candidate.p_focus_world = CentroidOf(candidate.beyond, voxel_m);
    candidate.standing = std::move(cluster);
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

/// First side of `key` for which `is_border` holds.
template <class F>
void AddBorder(Border& border, const VoxelKey& key, const F& is_border) {
  const auto side = std::find_if(kSides.begin(), kSides.end(),
                                 [&](const VoxelKey& s) { return is_border(key + s); });
  if (side != kSides.end()) border.emplace(key, key + *side);
}

}  // namespace

planner::LevelBand BandAround(double level_m, const FrontierConfig& config, double voxel_m) {
  // The support voxel of a floor at height h may lie below or above the voxel border at h.
  return {CellsFloor(level_m - config.level_band_m, voxel_m) - 1,
          CellsFloor(level_m + config.level_band_m, voxel_m)};
}

std::vector<Candidate> TraversableFrontiers(const VoxelMap& map, const planner::LevelBand& level,
                                            const FrontierConfig& config, int min_cluster) {
  const int column_vox = CellsFloor(config.unknown_column_m, map.config().voxel_m);
  Border border;
  Cursor cursor(map);
  ForEachStanding(map, level, [&](const VoxelKey& key) {
    AddBorder(border, key,
              [&](const VoxelKey& side) { return IsGenuineUnknown(cursor, side, column_vox); });
  });
  return CandidatesOf(border, CandidateKind::kTraversableFrontier, min_cluster,
                      map.config().voxel_m);
}

std::vector<Candidate> DescendFrontiers(const VoxelMap& map, const planner::LevelBand& level,
                                        const FrontierConfig& config) {
  Border border;
  Cursor cursor(map);
  ForEachStanding(map, level, [&](const VoxelKey& key) {
    AddBorder(border, key, [&](const VoxelKey& side) { return IsDrop(map, cursor, side, level); });
  });
  return CandidatesOf(border, CandidateKind::kDescendFrontier, config.min_cluster_init_descent,
                      map.config().voxel_m);
}

}  // namespace crossnav::policy
