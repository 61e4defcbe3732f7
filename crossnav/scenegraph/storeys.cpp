// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/storeys.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <set>

#include "crossnav/core/cells.h"

namespace crossnav::scenegraph {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;

constexpr double kHeadroom_m = 1.2;    // chosen: above a bed, not below a table
constexpr double kLevelArea_m2 = 4.0;  // chosen: more than a bed or a row of cupboards
constexpr double kStorey_m = 1.5;      // as sim::Floor: split levels above the lowest
constexpr double kReach_m = 2.0;       // chosen: furniture that hides the ground
constexpr double kCeilingFrom_m = 1.9, kCeilingTo_m = 4.5;  // chosen: above the ground

/// A connected piece of ground.
struct Level {
  int z = 0;  ///< lowest voxel above it
  std::vector<VoxelKey> columns;
};

bool HasHeadroom(VoxelMap::Cursor& cursor, const VoxelKey& surface, int voxels) {
  if (cursor.At({surface.x, surface.y, surface.z + 1}).state == geometry::VoxelState::kUnknown)
    return false;
  for (int k = 1; k <= voxels; ++k)
    if (IsSurface(cursor.At({surface.x, surface.y, surface.z + k}).state)) return false;
  return true;
}

/// Voxels above surfaces with head-room, by height.
std::map<int, std::set<VoxelKey>> StandingByHeight(const VoxelMap& map) {
  const int headroom = CellsCeil(kHeadroom_m, map.config().voxel_m);
  VoxelMap::Cursor cursor(map);
  std::map<int, std::set<VoxelKey>> standing;
  map.ForEach([&](const VoxelKey& key, const geometry::Voxel& voxel) {
    if (IsSurface(voxel.state) && HasHeadroom(cursor, key, headroom))
      standing[key.z + 1].insert({key.x, key.y, key.z + 1});
  });
  return standing;
}

/// Removes the piece that holds `seed` from `standing`: heights within one voxel of the seed's.
Level TakePiece(std::map<int, std::set<VoxelKey>>& standing, VoxelKey seed) {
  Level level{seed.z, {}};
  std::deque<VoxelKey> open = {seed};
  standing[seed.z].erase(seed);
  while (!open.empty()) {
    const VoxelKey at = open.front();
    open.pop_front();
    level.columns.push_back(at);
    for (const GridStep& step : kSides)
      for (int z = seed.z - 1; z <= seed.z + 1; ++z) {
        const VoxelKey next{at.x + step.dx, at.y + step.dy, z};
        const auto row = standing.find(z);
        if (row != standing.end() && row->second.erase(next) > 0) open.push_back(next);
      }
  }
  return level;
}

/// Heights with the most ground first, so that the main height names a piece.
std::vector<Level> LevelsOf(const VoxelMap& map) {
  auto standing = StandingByHeight(map);
  std::vector<std::pair<std::size_t, int>> order;
  for (const auto& [z, keys] : standing) order.emplace_back(keys.size(), z);
  std::sort(order.begin(), order.end(), std::greater<>());
  const double cell_m2 = map.config().voxel_m * map.config().voxel_m;
  std::vector<Level> levels;
  for (const auto& [count, z] : order) {
    while (!standing[z].empty()) {
      Level level = TakePiece(standing, *standing[z].begin());
      if (static_cast<double>(level.columns.size()) * cell_m2 >= kLevelArea_m2)
        levels.push_back(std::move(level));
    }
  }
  std::sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.z < b.z; });
  return levels;
}

GridFrame FrameOf(const std::vector<Level>& levels, int margin) {
  int x0 = std::numeric_limits<int>::max(), y0 = x0, x1 = -x0, y1 = -x0;
  for (const Level& level : levels)
    for (const VoxelKey& key : level.columns) {
      x0 = std::min(x0, key.x), x1 = std::max(x1, key.x);
      y0 = std::min(y0, key.y), y1 = std::max(y1, key.y);
    }
  return {x0 - margin, y0 - margin, x1 - x0 + 1 + 2 * margin, y1 - y0 + 1 + 2 * margin};
}

/// Ground of the levels, dilated by `reach` columns.
PlanGrid<int> GroundOf(const GridFrame& frame, const std::vector<const Level*>& levels, int reach) {
  PlanGrid<int> ground(frame, kNoGround);
  std::vector<std::size_t> ring;
  for (const Level* level : levels)
    for (const VoxelKey& key : level->columns) {
      int& z = ground.cells[frame.IndexOf(key.x, key.y)];
      if (z == kNoGround) ring.push_back(frame.IndexOf(key.x, key.y));
      if (z == kNoGround || level->z < z) z = level->z;
    }
  for (int k = 0; k < reach; ++k) {
    std::vector<std::size_t> next;
    for (const std::size_t at : ring)
      ForEachBeside(frame, at, kSides, [&](std::size_t beside) {
        if (ground.cells[beside] != kNoGround) return;
        ground.cells[beside] = ground.cells[at];
        next.push_back(beside);
      });
    ring = std::move(next);
  }
  return ground;
}

std::optional<double> CeilingOf(const VoxelMap& map, const std::vector<const Level*>& levels) {
  const double voxel_m = map.config().voxel_m;
  VoxelMap::Cursor cursor(map);
  std::map<int, int> undersides;
  int columns = 0, seen = 0;
  for (const Level* level : levels)
    for (const VoxelKey& key : level->columns) {
      ++columns;
      const int to = key.z + CellsCeil(kCeilingTo_m, voxel_m);
      int z = key.z + CellsFloor(kCeilingFrom_m, voxel_m);
      while (z < to && !IsSurface(cursor.At({key.x, key.y, z}).state)) ++z;
      if (z < to) ++undersides[z], ++seen;
    }
  if (seen == 0 || 4 * seen < columns) return std::nullopt;
  const auto most =
      std::max_element(undersides.begin(), undersides.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most->first * voxel_m;
}

Storey StoreyOf(const VoxelMap& map, const GridFrame& frame,
                const std::vector<const Level*>& levels) {
  const double voxel_m = map.config().voxel_m;
  Storey storey;
  std::size_t columns = 0, largest = 0;
  for (const Level* level : levels) {
    columns += level->columns.size();
    if (level->columns.size() <= largest) continue;
    largest = level->columns.size();
    storey.height_m = level->z * voxel_m;
  }
  storey.area_m2 = static_cast<double>(columns) * voxel_m * voxel_m;
  storey.ceiling_m = CeilingOf(map, levels);
  storey.ground_z = GroundOf(frame, levels, CellsCeil(kReach_m, voxel_m));
  return storey;
}

}  // namespace

std::vector<Storey> FindStoreys(const VoxelMap& map) {
  const double voxel_m = map.config().voxel_m;
  const std::vector<Level> levels = LevelsOf(map);
  if (levels.empty()) return {};
  const GridFrame frame = FrameOf(levels, CellsCeil(kReach_m, voxel_m));
  std::vector<Storey> storeys;
  std::vector<const Level*> group;
  for (const Level& level : levels) {
    if (!group.empty() && (level.z - group.front()->z) * voxel_m >= kStorey_m - 0.5 * voxel_m) {
      storeys.push_back(StoreyOf(map, frame, group));
      group.clear();
    }
    group.push_back(&level);
  }
  storeys.push_back(StoreyOf(map, frame, group));
  return storeys;
}

}  // namespace crossnav::scenegraph
