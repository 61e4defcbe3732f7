// SPDX-License-Identifier: MIT
#include "crossnav/memory/history_poi.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "crossnav/core/cells.h"
#include "crossnav/geometry/sparse_grid.h"

namespace crossnav::memory {
namespace {

// Median and median absolute deviation (scaled to a normal's sigma) of the field, and its peak.
struct FieldStats {
  double median = 0;
  double deviation = 0;
  double peak = 0;  // mean of the highest few
};

double MedianOf(std::vector<float>& values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

FieldStats StatsOf(std::span<const float> field, int peak_count) {
  std::vector<float> values(field.begin(), field.end());
  FieldStats stats;
  stats.median = MedianOf(values);
  const auto count = std::min<std::size_t>(values.size(), peak_count);
  std::partial_sort(values.begin(), values.begin() + count, values.end(), std::greater<>());
  stats.peak = std::accumulate(values.begin(), values.begin() + count, 0.0) / count;
  for (float& v : values) v = static_cast<float>(std::abs(v - stats.median));
  // Lower bound: without it rounding errors would stand out in a field of equal values.
  stats.deviation = std::max(1.4826 * MedianOf(values), 1e-3);
  return stats;
}

std::vector<std::int64_t> StandoutRows(std::span<const float> field, std::span<const float> cosine,
                                       const FieldStats& stats, const QueryConfig& config) {
  const double threshold =
      stats.median + std::max(config.min_z_score * stats.deviation,
                              config.min_peak_share * (stats.peak - stats.median));
  std::vector<std::int64_t> rows;
  for (std::size_t row = 0; row < field.size(); ++row)
    if (field[row] >= threshold && cosine[row] >= config.min_similarity)
      rows.push_back(static_cast<std::int64_t>(row));
  return rows;
}

// Indices of the member voxels of a block, for neighbour look-up.
struct MemberBlock {
  std::array<std::int32_t, geometry::kBlockVoxels> member;
  MemberBlock() { member.fill(-1); }
};

std::int32_t Root(std::vector<std::int32_t>& parent, std::int32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Half of the ball's offsets; the neighbour's own search covers the other half.
std::vector<VoxelKey> ForwardOffsets(double radius_vox) {
  const int r = CellsFloor(radius_vox, 1.0);
  std::vector<VoxelKey> offsets;
  for (int z = -r; z <= r; ++z)
    for (int y = -r; y <= r; ++y)
      for (int x = -r; x <= r; ++x) {
        const VoxelKey offset{x, y, z};
        if (offset > VoxelKey{} && geometry::VoxelDistance(offset, {}) <= radius_vox + 1e-9)
          offsets.push_back(offset);
      }
  return offsets;
}

// Groups of rows whose voxels chain within `radius_vox`; each ascending, groups by first row.
std::vector<std::vector<std::int64_t>> ClusterRows(const SemanticMemory& memory,
                                                   std::span<const std::int64_t> rows,
                                                   double radius_vox) {
  geometry::SparseGrid<MemberBlock> grid;
  std::vector<std::int32_t> parent(rows.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const VoxelKey& key = memory.Keys()[rows[i]];
    grid.Touch(geometry::BlockKeyOf(key)).member[geometry::CellIndexOf(key)] =
        static_cast<std::int32_t>(i);
  }
  const std::vector<VoxelKey> offsets = ForwardOffsets(radius_vox);
  geometry::GridReader<MemberBlock> reader(grid);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const VoxelKey& offset : offsets) {
      const VoxelKey key = memory.Keys()[rows[i]] + offset;
      const MemberBlock* block = reader.Find(key);
      const std::int32_t other = block ? block->member[geometry::CellIndexOf(key)] : -1;
      if (other < 0) continue;
      const std::int32_t a = Root(parent, static_cast<std::int32_t>(i)), b = Root(parent, other);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::vector<std::int64_t>> groups;
  std::vector<std::int32_t> group_of(rows.size(), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::int32_t root = Root(parent, static_cast<std::int32_t>(i));
    if (group_of[root] < 0) {
      group_of[root] = static_cast<std::int32_t>(groups.size());
      groups.emplace_back();
    }
    groups[group_of[root]].push_back(rows[i]);
  }
  return groups;
}

// Camera position with the best views of most of the cluster, weighted by frame confidence.
Vector3d BestView(const SemanticMemory& memory, std::span<const std::int64_t> rows) {
  struct View {
    std::array<float, 3> p;
    double confidence;
  };
  std::vector<View> views;
  for (std::int64_t row : rows) {
    const Vector3f p = memory.BestViewOf(row);
    views.push_back({{p.x(), p.y(), p.z()}, memory.BestConfidenceOf(row)});
  }
  std::stable_sort(views.begin(), views.end(),
                   [](const View& a, const View& b) { return a.p < b.p; });
  View best{{}, -1};
  for (std::size_t i = 0; i < views.size();) {
    View sum{views[i].p, 0};
    for (; i < views.size() && views[i].p == sum.p; ++i) sum.confidence += views[i].confidence;
    if (sum.confidence > best.confidence) best = sum;
  }
  return {best.p[0], best.p[1], best.p[2]};
}

MemoryCluster MakeCluster(const SemanticMemory& memory, std::vector<std::int64_t> rows,
                          std::span<const float> field, std::span<const float> cosine,
                          const FieldStats& stats) {
  MemoryCluster cluster;
  cluster.rows = std::move(rows);
  double total = 0;
  for (std::int64_t row : cluster.rows) {
    const VoxelKey& key = memory.Keys()[row];
    cluster.voxels.push_back(key);
    const double excess = std::max(field[row] - stats.median, 1e-6);
    cluster.p_center_world += excess * geometry::CenterOf(key, memory.VoxelSize());
    total += excess;
    cluster.box.Add(geometry::MinCornerOf(key, memory.VoxelSize()));
    cluster.box.Add(geometry::MinCornerOf(key + VoxelKey{1, 1, 1}, memory.VoxelSize()));
  }
  cluster.p_center_world /= total;
  std::sort(cluster.voxels.begin(), cluster.voxels.end());

  std::vector<std::int64_t> best = cluster.rows;
  std::sort(best.begin(), best.end(),
            [&](auto a, auto b) { return field[a] != field[b] ? field[a] > field[b] : a < b; });
  best.resize((best.size() + 3) / 4);
  double excess = 0;
  for (std::int64_t row : best) {
    excess += (field[row] - stats.median) / stats.deviation;
    cluster.similarity += cosine[row];
  }
  cluster.similarity /= static_cast<double>(best.size());
  cluster.score = excess / static_cast<double>(best.size()) *
                  std::log2(1.0 + static_cast<double>(cluster.rows.size()));
  cluster.p_best_view_world = BestView(memory, cluster.rows);
  const Vector3d to_center = cluster.p_center_world - cluster.p_best_view_world;
  cluster.best_view_yaw_rad = std::atan2(to_center.y(), to_center.x());
  cluster.best_view_pitch_rad = std::atan2(to_center.z(), to_center.head<2>().norm());
  return cluster;
}

// Relevancy against the strongest background prompt.
std::vector<float> Contrast(const SemanticMemory& memory, std::span<const float> cosine,
                            double contrast, std::span<const std::vector<float>> background) {
  std::vector<float> relevancy(cosine.size(), 1.0f);
  for (const std::vector<float>& prompt : background) {
    const std::vector<float> other = memory.Similarity(prompt);
    for (std::size_t row = 0; row < relevancy.size(); ++row) {
      const double odds = std::exp(contrast * (static_cast<double>(other[row]) - cosine[row]));
      relevancy[row] = std::min(relevancy[row], static_cast<float>(1.0 / (1.0 + odds)));
    }
  }
  return relevancy;
}

}  // namespace

std::vector<float> RelevancyField(const SemanticMemory& memory, std::span<const float> text,
                                  const QueryConfig& config,
                                  std::span<const std::vector<float>> background) {
  std::vector<float> cosine = memory.Similarity(text);
  if (config.relevancy != "contrastive" || background.empty()) return cosine;
  return Contrast(memory, cosine, config.contrast, background);
}

std::vector<MemoryCluster> Query(const SemanticMemory& memory, std::span<const float> text,
                                 const QueryConfig& config,
                                 std::span<const std::vector<float>> background) {
  if (memory.Size() == 0) return {};
  const std::vector<float> cosine = memory.Similarity(text);
  const bool is_contrastive = config.relevancy == "contrastive" && !background.empty();
  const std::vector<float> field =
      is_contrastive ? Contrast(memory, cosine, config.contrast, background) : cosine;
  const FieldStats stats = StatsOf(field, 4 * config.min_voxels);
  const std::vector<std::int64_t> rows = StandoutRows(field, cosine, stats, config);

  std::vector<MemoryCluster> clusters;
  for (auto& group : ClusterRows(memory, rows, config.cluster_radius_vox))
    if (static_cast<int>(group.size()) >= config.min_voxels)
      clusters.push_back(MakeCluster(memory, std::move(group), field, cosine, stats));
  std::sort(clusters.begin(), clusters.end(), [](const MemoryCluster& a, const MemoryCluster& b) {
    return a.score != b.score ? a.score > b.score : a.voxels < b.voxels;
  });
  if (static_cast<int>(clusters.size()) > config.top_k) clusters.resize(config.top_k);
  return clusters;
}

}  // namespace crossnav::memory
