// SPDX-License-Identifier: MIT
#include "crossnav/memory/semantic_memory.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "crossnav/core/check.h"
#include "crossnav/geometry/sparse_grid.h"
#include "crossnav/memory/frame_lift.h"
#include "crossnav/memory/observation_quality.h"
#include "crossnav/memory/row_store.h"

namespace crossnav::memory {
namespace {

using geometry::EndRun;

struct RowBlock {
  std::array<std::int32_t, geometry::kBlockVoxels> row;
  RowBlock() { row.fill(-1); }
};
using RowGrid = geometry::SparseGrid<RowBlock>;

/// Joins the run at `*i` with its continuations in the same row of `width` pixels; moves `*i`
/// behind them.
EndRun TakeRun(std::span<const EndRun> runs, int width, std::size_t* i) {
  EndRun run = runs[(*i)++];
  for (; *i < runs.size(); ++*i) {
    const EndRun& next = runs[*i];
    const bool goes_on = next.key == run.key && next.pixel == run.pixel + run.count;
    if (!goes_on || next.pixel % width == 0) break;
    run.count += next.count;
  }
  return run;
}

struct RowFacts {
  float weight = 0;
  float best_confidence = 0;
  Vector3f p_best_view_world = Vector3f::Zero();
};

}  // namespace

struct SemanticMemory::Impl {
  FusionConfig config;
  double voxel_m;
  RowStore rows;
  std::vector<VoxelKey> keys;
  std::vector<RowFacts> facts;
  RowGrid index;
  MemoryCounters counters;

  // Scratch of one frame, kept to avoid allocation.
  QualityRows quality;
  GridAxis u_axis, v_axis;
  RowSums row_sums;
  CellWeights weights;
  struct LineRun {
    EndRun run;
    std::int32_t* index_cell = nullptr;  // of its voxel
  };
  std::vector<LineRun> line;              // the runs of one row of the image
  std::vector<std::int32_t> slot_of_row;  // -1 outside Fuse
  std::vector<std::int32_t> row_of_slot;

  Impl(const FusionConfig& c, double voxel, int dim)
      : config(c), voxel_m(voxel), rows(c.storage != "float", dim) {}

  std::int32_t AppendKey(const VoxelKey& key, std::int32_t& index_cell) {
    index_cell = static_cast<std::int32_t>(rows.Append());
    keys.push_back(key);
    facts.emplace_back();
    slot_of_row.push_back(-1);
    return index_cell;
  }

  std::int32_t SlotOf(std::int32_t& index_cell, const VoxelKey& key) {
    const std::int32_t row = index_cell >= 0 ? index_cell : AppendKey(key, index_cell);
    if (slot_of_row[row] < 0) {
      slot_of_row[row] = weights.AddSlot();
      row_of_slot.push_back(row);
    }
    return slot_of_row[row];
  }

  void PrepareAxes(const DepthImage& depth_m, const FeatureGridView& grid) {
    if (u_axis.cells != grid.cols || static_cast<int>(u_axis.first.size()) != depth_m.width)
      u_axis = GridAxis::Make(depth_m.width, grid.cols);
    if (v_axis.cells != grid.rows || static_cast<int>(v_axis.first.size()) != depth_m.height)
      v_axis = GridAxis::Make(depth_m.height, grid.rows);
    weights.Reset(u_axis, v_axis);
    row_of_slot.clear();
  }

  void GatherWeights(std::span<const EndRun> runs, int width);
  void GatherLine(int v, int row_begin);
  void FuseSlot(std::int32_t slot, const float* grid, const Vector3f& p_camera_world);
  void EnforceLimit();
  void KeepMostConfident(std::int64_t count);
  void CompactLeastConfident(std::int64_t count);
  void Reindex();

  // Ties go by key, so that the result does not depend on the order of rows.
  bool IsMoreConfident(std::int64_t a, std::int64_t b) const {
    return facts[a].weight != facts[b].weight ? facts[a].weight > facts[b].weight
                                              : keys[a] < keys[b];
  }
};

// Row by row of the image. The data of a run lies anywhere in memory; the runs of a whole row are
// prefetched before use.
void SemanticMemory::Impl::GatherWeights(std::span<const EndRun> runs, int width) {
  geometry::KnownBlocks<RowBlock> blocks;
  const auto find = [this](const VoxelKey& block_key) -> RowBlock& {
    return index.Touch(block_key);
  };
  for (std::size_t i = 0; i < runs.size();) {
    const int v = runs[i].pixel / width, row_begin = v * width;
    line.clear();
    while (i < runs.size() && runs[i].pixel >= row_begin && runs[i].pixel < row_begin + width) {
      const EndRun run = TakeRun(runs, width, &i);
      std::int32_t* cell = &blocks.Of(run.key, find).row[geometry::CellIndexOf(run.key)];
      PrefetchLine(cell);
      line.push_back({run, cell});
    }
    for (const LineRun& run : line)
      if (*run.index_cell >= 0) PrefetchLine(&slot_of_row[*run.index_cell]);
    row_sums.Reset(quality.Row(v), u_axis);
    GatherLine(v, row_begin);
  }
}

// Cuts the joined runs at the borders of cell intervals.
void SemanticMemory::Impl::GatherLine(int v, int row_begin) {
  CellWeights::Run piece;
  piece.v_cell = v_axis.first[v];
  piece.v_fraction = v_axis.factors[v].fraction;
  for (const LineRun& run : line) {
    const int begin = run.run.pixel - row_begin, end = begin + run.run.count;
    std::int32_t slot = -1;
    for (int u = begin, next = 0; u < end; u = next) {
      piece.u_cell = u_axis.first[u];
      next = std::min(end, u_axis.end[piece.u_cell]);
      const RowSums::Sums sums = row_sums.Of(u, next - 1, piece.u_cell);
      if (sums.total <= 0) continue;
      piece.total = sums.total;
      piece.right = sums.right;
      if (slot < 0) slot = SlotOf(*run.index_cell, run.run.key);
      weights.Add(slot, piece);
    }
  }
}

// eq:intra_frame_fusion and eq:supp_feature_fusion in one pass over the row.
void SemanticMemory::Impl::FuseSlot(std::int32_t slot, const float* grid,
                                    const Vector3f& p_camera_world) {
  const std::int32_t row = row_of_slot[slot];
  RowFacts& fact = facts[row];
  const double confidence = weights.Total(slot);
  const double sum = fact.weight + confidence;
  const double divisor = (confidence + config.epsilon) * sum / confidence;
  rows.Fuse(row, static_cast<float>(fact.weight / sum), grid, weights.Shares(slot, divisor));
  fact.weight = static_cast<float>(sum);
  if (confidence > fact.best_confidence) {
    fact.best_confidence = static_cast<float>(confidence);
    fact.p_best_view_world = p_camera_world;
  }
}

// A compact row costs half a row. Frees a tenth more than needed, so that compaction is rare.
void SemanticMemory::Impl::EnforceLimit() {
  const std::int64_t limit = config.max_rows;
  if (limit <= 0 || 2 * rows.size() - rows.CompactCount() <= 2 * limit) return;
  const std::int64_t aim = std::max<std::int64_t>(1, limit - limit / 10);
  if (rows.size() > 2 * aim) KeepMostConfident(2 * aim);
  CompactLeastConfident(2 * (rows.size() - aim) - rows.CompactCount());
}

void SemanticMemory::Impl::KeepMostConfident(std::int64_t count) {
  std::vector<std::int64_t> order(rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::nth_element(order.begin(), order.begin() + count, order.end(),
                   [&](auto a, auto b) { return IsMoreConfident(a, b); });
  counters.dropped_rows += rows.size() - count;
  order.resize(count);
  std::sort(order.begin(), order.end());
  rows.Keep(order);
  for (std::int64_t to = 0; to < count; ++to) {
    keys[to] = keys[order[to]];
    facts[to] = facts[order[to]];
  }
  keys.resize(count);
  facts.resize(count);
  slot_of_row.resize(count);
  Reindex();
}

// Compacts the `count` least confident full rows.
void SemanticMemory::Impl::CompactLeastConfident(std::int64_t count) {
  if (count <= 0) return;
  std::vector<std::int64_t> full;
  for (std::int64_t row = 0; row < rows.size(); ++row)
    if (!rows.IsCompact(row)) full.push_back(row);
  CROSSNAV_CHECK(count <= static_cast<std::int64_t>(full.size()), "enough rows are left");
  std::nth_element(full.begin(), full.end() - count, full.end(),
                   [&](auto a, auto b) { return IsMoreConfident(a, b); });
  std::sort(full.end() - count, full.end());
  for (auto row = full.end() - count; row != full.end(); ++row) rows.Compact(*row);
}

void SemanticMemory::Impl::Reindex() {
  index = RowGrid();
  for (std::size_t row = 0; row < keys.size(); ++row)
    index.Touch(geometry::BlockKeyOf(keys[row])).row[geometry::CellIndexOf(keys[row])] =
        static_cast<std::int32_t>(row);
}

SemanticMemory::SemanticMemory(const FusionConfig& config, double voxel_m, int dim)
    : impl_(std::make_unique<Impl>(config, voxel_m, dim)) {}
SemanticMemory::~SemanticMemory() = default;
SemanticMemory::SemanticMemory(SemanticMemory&&) noexcept = default;
SemanticMemory& SemanticMemory::operator=(SemanticMemory&&) noexcept = default;

void SemanticMemory::Fuse(const std::vector<PixelVoxel>& pixels, const DepthImage& depth_m,
                          const CameraIntrinsics& camera, const Pose& T_world_camera,
                          const FeatureGridView& features) {
  FuseRuns(geometry::RunsOf(pixels, depth_m.width), depth_m, camera, T_world_camera, features);
}

void SemanticMemory::FuseRuns(std::span<const EndRun> runs, const DepthImage& depth_m,
                              const CameraIntrinsics& camera, const Pose& T_world_camera,
                              const FeatureGridView& features) {
  Impl& m = *impl_;
  CROSSNAV_CHECK(features.rows > 0 && features.cols > 0 && features.dim > 0 &&
                     features.data.size() ==
                         static_cast<std::size_t>(features.rows) * features.cols * features.dim,
                 "a feature grid of rows x cols x dim");
  if (m.rows.dim() == 0) m.rows.SetDim(features.dim);
  CROSSNAV_CHECK(features.dim == m.rows.dim(), "the feature dimension does not change");
  if (!AllFinite(features.data)) {
    ++m.counters.rejected_frames;
    return;
  }
  m.quality.Reset(depth_m, camera, m.config);
  m.PrepareAxes(depth_m, features);
  m.GatherWeights(runs, depth_m.width);
  const Vector3f p_camera_world = T_world_camera.translation().cast<float>();
  constexpr std::int32_t kAhead = 8;  // chosen: 4, 16 and 32 take the same time
  for (std::int32_t slot = 0; slot < m.weights.size(); ++slot) {
    if (slot + kAhead < m.weights.size()) {
      m.rows.Prefetch(m.row_of_slot[slot + kAhead]);
      PrefetchLine(&m.facts[m.row_of_slot[slot + kAhead]]);
    }
    m.FuseSlot(slot, features.data.data(), p_camera_world);
  }
  for (std::int32_t row : m.row_of_slot) m.slot_of_row[row] = -1;
  m.EnforceLimit();
}

int SemanticMemory::Dim() const {
  return impl_->rows.dim();
}
std::int64_t SemanticMemory::Size() const {
  return impl_->rows.size();
}
std::span<const VoxelKey> SemanticMemory::Keys() const {
  return impl_->keys;
}
float SemanticMemory::WeightAt(std::int64_t row) const {
  return impl_->facts[row].weight;
}
std::vector<float> SemanticMemory::FeatureAt(std::int64_t row) const {
  return impl_->rows.Read(row);
}

std::optional<std::int64_t> SemanticMemory::RowOf(const VoxelKey& key) const {
  const RowBlock* block = impl_->index.Find(geometry::BlockKeyOf(key));
  if (block == nullptr) return std::nullopt;
  const std::int32_t row = block->row[geometry::CellIndexOf(key)];
  return row < 0 ? std::nullopt : std::optional<std::int64_t>(row);
}

Vector3f SemanticMemory::BestViewOf(std::int64_t row) const {
  return impl_->facts[row].p_best_view_world;
}
float SemanticMemory::BestConfidenceOf(std::int64_t row) const {
  return impl_->facts[row].best_confidence;
}

std::int64_t SemanticMemory::Bytes() const {
  const Impl& m = *impl_;
  return m.rows.Bytes() +
         static_cast<std::int64_t>(m.index.Bytes() + m.keys.capacity() * sizeof(VoxelKey) +
                                   m.facts.capacity() * sizeof(RowFacts) +
                                   m.slot_of_row.capacity() * sizeof(std::int32_t) +
                                   m.weights.Bytes() + m.quality.Bytes());
}

MemoryCounters SemanticMemory::Counters() const {
  MemoryCounters counters = impl_->counters;
  counters.compacted_rows = impl_->rows.CompactCount();
  return counters;
}
const FusionConfig& SemanticMemory::config() const {
  return impl_->config;
}
double SemanticMemory::VoxelSize() const {
  return impl_->voxel_m;
}

MemoryRow SemanticMemory::RowAt(std::int64_t row) const {
  const RowFacts& fact = impl_->facts[row];
  MemoryRow out;
  out.key = impl_->keys[row];
  out.weight = fact.weight;
  out.best_confidence = fact.best_confidence;
  out.p_best_view_world = fact.p_best_view_world;
  if (impl_->rows.IsCompact(row)) {
    out.compact.resize(impl_->rows.dim());
    out.scale = impl_->rows.ReadCompact(row, out.compact);
  } else {
    out.half.resize(impl_->rows.dim());
    impl_->rows.ReadHalf(row, out.half);
  }
  return out;
}

void SemanticMemory::AppendRow(const MemoryRow& row) {
  Impl& m = *impl_;
  const bool is_compact = !row.compact.empty();
  const std::size_t dim = is_compact ? row.compact.size() : row.half.size();
  if (m.rows.dim() == 0) m.rows.SetDim(static_cast<int>(dim));
  std::int32_t& cell =
      m.index.Touch(geometry::BlockKeyOf(row.key)).row[geometry::CellIndexOf(row.key)];
  CROSSNAV_CHECK(cell < 0, "each voxel has one row");
  m.AppendKey(row.key, cell);
  if (is_compact)
    m.rows.WriteCompact(cell, row.compact, row.scale);
  else
    m.rows.WriteHalf(cell, row.half);
  m.facts.back() = {row.weight, row.best_confidence, row.p_best_view_world};
}

void SemanticMemory::LimitWeights(float most) {
  for (auto& fact : impl_->facts) fact.weight = std::min(fact.weight, most);
}

void SemanticMemory::ReorderRows(std::span<const std::int64_t> order) {
  Impl& m = *impl_;
  CROSSNAV_CHECK(static_cast<std::int64_t>(order.size()) == Size(), "an order of all rows");
  m.rows.Reorder(order);
  std::vector<VoxelKey> keys(order.size());
  std::vector<RowFacts> facts(order.size());
  for (std::size_t to = 0; to < order.size(); ++to) {
    keys[to] = m.keys[order[to]];
    facts[to] = m.facts[order[to]];
  }
  m.keys = std::move(keys);
  m.facts = std::move(facts);
  m.Reindex();
}

void SemanticMemory::AddDropped(std::int64_t rows) {
  impl_->counters.dropped_rows += rows;
}

std::vector<float> SemanticMemory::Similarity(std::span<const float> text) const {
  return impl_->rows.Cosines(text);
}

}  // namespace crossnav::memory
