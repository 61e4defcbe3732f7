// SPDX-License-Identifier: MIT
// The 2D map of the baseline OneMap: certainty of observation per column of the world, and columns
// with a place to stand. Columns are voxel columns; World frame.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>

#include "crossnav/core/observation.h"
#include "crossnav/geometry/end_voxel_list.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/planner/astar.h"
#include "crossnav/policy/onemap_config.h"

namespace crossnav::policy {

struct Column {
  std::int32_t x = 0, y = 0;
  friend auto operator<=>(const Column&, const Column&) = default;  // NOLINT: takes 0 for null
};

struct ColumnBelief {
  double confidence = 0;  ///< sum over frames of the mean weight of the column's pixels
  double checked = 0;     ///< the same since the goal was set
};

class OneMapMap {
 public:
  /// Adds a frame: the weight of a pixel is eq:supp_observation_quality, which is OneMap's own.
  void Add(const geometry::EndVoxels& ends, const Observation& obs,
           const memory::FusionConfig& fusion);
  /// A new goal: nothing was checked for it yet.
  void ClearChecked();

  bool IsObserved(const Column& c) const { return columns_.contains(c); }
  bool IsExplored(const Column& c, const OneMapConfig& config) const;
  bool IsChecked(const Column& c, const OneMapConfig& config) const;
  const std::map<Column, ColumnBelief>& columns() const { return columns_; }

 private:
  std::map<Column, ColumnBelief> columns_;
};

/// Places to stand on the level: column -> lowest free standing voxel.
using StandingColumns = std::map<Column, geometry::VoxelKey>;
StandingColumns StandingOn(const geometry::VoxelMap& map, const planner::LevelBand& level);

/// Cosine of each column of the planar memory with the goal.
using SimilarityField = std::map<Column, double>;
SimilarityField SimilarityOf(const memory::SemanticMemory& memory, const std::vector<float>& text);

}  // namespace crossnav::policy
