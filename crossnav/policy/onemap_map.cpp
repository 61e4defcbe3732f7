// SPDX-License-Identifier: MIT
#include "crossnav/policy/onemap_map.h"

#include "crossnav/memory/observation_quality.h"

namespace crossnav::policy {

void OneMapMap::Add(const geometry::EndVoxels& ends, const Observation& obs,
                    const memory::FusionConfig& fusion) {
  struct Sum {
    double weight = 0;
    int count = 0;
  };
  memory::QualityRows quality;
  quality.Reset(obs.depth_m, obs.camera, fusion);
  std::map<Column, Sum> frame;
  for (const geometry::EndRun& run : ends.runs()) {
    const float* row = quality.Row(run.pixel / obs.depth_m.width);
    Sum& sum = frame[{run.key.x, run.key.y}];
    for (std::int32_t i = 0; i < run.count; ++i)
      sum.weight += row[run.pixel % obs.depth_m.width + i];
    sum.count += run.count;
  }
  for (const auto& [column, sum] : frame) {
    ColumnBelief& belief = columns_[column];
    belief.confidence += sum.weight / sum.count;
    belief.checked += sum.weight / sum.count;
  }
}

void OneMapMap::ClearChecked() {
  for (auto& [column, belief] : columns_) belief.checked = 0;
}

bool OneMapMap::IsExplored(const Column& c, const OneMapConfig& config) const {
  const auto it = columns_.find(c);
  return it != columns_.end() && it->second.confidence >= config.explored_confidence;
}

bool OneMapMap::IsChecked(const Column& c, const OneMapConfig& config) const {
  const auto it = columns_.find(c);
  return it != columns_.end() && it->second.checked >= config.explored_confidence;
}

StandingColumns StandingOn(const geometry::VoxelMap& map, const planner::LevelBand& level) {
  StandingColumns standing;
  geometry::VoxelMap::Cursor cursor(map);
  map.ForEachInSlab(level.min_z + 1, level.max_z + 1,
                    [&](const geometry::VoxelKey& key, const geometry::Voxel& voxel) {
                      if (voxel.state != geometry::VoxelState::kTraversable || voxel.is_inflated)
                        return;
                      if (!IsSurface(cursor.At({key.x, key.y, key.z - 1}).state)) return;
                      const auto [it, is_new] = standing.try_emplace({key.x, key.y}, key);
                      if (!is_new && key.z < it->second.z) it->second = key;
                    });
  return standing;
}

SimilarityField SimilarityOf(const memory::SemanticMemory& memory, const std::vector<float>& text) {
  SimilarityField field;
  if (memory.Size() == 0) return field;
  const std::vector<float> cosines = memory.Similarity(text);
  const auto keys = memory.Keys();
  for (std::size_t row = 0; row < keys.size(); ++row) {
    const auto [it, is_new] = field.try_emplace({keys[row].x, keys[row].y}, cosines[row]);
    if (!is_new) it->second = std::max(it->second, static_cast<double>(cosines[row]));
  }
  return field;
}

}  // namespace crossnav::policy
