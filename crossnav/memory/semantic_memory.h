// SPDX-License-Identifier: MIT
// The persistent semantic memory (paper, "Persistent 3D Semantic Memory"): one feature row per
// surface voxel, the cumulative weighted average of all its observations. Rows are half precision,
// weights float32. Independent of the goal. World frame, metres. Readers may share it while nobody
// writes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/core/setting.h"
#include "crossnav/geometry/voxel_key.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::memory {

using geometry::PixelVoxel;
using geometry::VoxelKey;

/// tab:supp_configuration, rows "Fusion".
struct FusionConfig {
  double gamma = 0.20;             ///< depth-gradient factor
  double preferred_depth_m = 1.0;  ///< d0
  double depth_scale_m = 1.5;      ///< sigma_d
  double gradient_scale = 0;       ///< 0 = width^2 / (640 fx): the same at every resolution
  double epsilon = 1e-6;           ///< eq:intra_frame_fusion
  /// Budget of feature rows, 0 = unbounded. Above it the least confident rows become int8, counted
  /// as half a row; if that does not suffice, the least confident rows are dropped.
  int max_rows = 0;
  std::string storage = "half";  ///< half | float; float doubles the memory, for comparison
};

template <class V>
void Visit(V& visit, FusionConfig& c) {
  visit(CROSSNAV_SETTING(c, gamma), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, preferred_depth_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, depth_scale_m), 0.01, 100.0);
  visit(CROSSNAV_SETTING(c, gradient_scale), 0.0, 1e6);
  visit(CROSSNAV_SETTING(c, epsilon), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, max_rows), 0, 1000000000);
  visit(CROSSNAV_SETTING(c, storage), {"half", "float"});
}

/// Dense features of one frame; a view of perception's grid, because this room may not include
/// perception.
struct FeatureGridView {
  int rows = 0, cols = 0, dim = 0;
  std::span<const float> data;  ///< rows x cols x dim
};

/// Observation quality q(u, v) of every pixel, 0 where depth is invalid
/// (eq:supp_observation_quality).
Image<float> ObservationQuality(const DepthImage& depth_m, const CameraIntrinsics& camera,
                                const FusionConfig& config);

/// A row in its saved form.
struct MemoryRow {
  VoxelKey key;
  float weight = 0;           ///< cumulative confidence
  float best_confidence = 0;  ///< of the best single frame
  Vector3f p_best_view_world = Vector3f::Zero();
  std::vector<std::uint16_t> half{};   ///< Dim() half-precision bit patterns, or
  std::vector<std::int8_t> compact{};  ///< of a compacted row, Dim() numbers ...
  float scale = 0;                     ///< ... times this factor, > 0

  friend bool operator==(const MemoryRow&, const MemoryRow&) = default;
};

/// Losses of the memory under its budget, and rejected frames.
struct MemoryCounters {
  std::int64_t compacted_rows = 0;   ///< currently int8 under max_rows
  std::int64_t dropped_rows = 0;     ///< dropped under max_rows since the start
  std::int64_t rejected_frames = 0;  ///< features that were not finite
};

class SemanticMemory {
 private:
  struct Impl;

 public:
  /// `dim` 0: the first grid sets the dimension.
  explicit SemanticMemory(const FusionConfig& config = {}, double voxel_m = 0.10, int dim = 0);
  ~SemanticMemory();
  SemanticMemory(SemanticMemory&&) noexcept;
  SemanticMemory& operator=(SemanticMemory&&) noexcept;

  /// Lifts the frame's features to the end voxels `runs` (from VoxelMap::Integrate) and fuses them
  /// (eq:intra_frame_fusion, eq:supp_feature_fusion). Rejects and counts a grid with NaN or
  /// infinity. With `max_rows` set, row numbers may change in this call only.
  void FuseRuns(std::span<const geometry::EndRun> runs, const DepthImage& depth_m,
                const CameraIntrinsics& camera, const Pose& T_world_camera,
                const FeatureGridView& features);
  /// Scalar reference of FuseRuns: pixel by pixel, in the order of pixels.
  void Fuse(const std::vector<PixelVoxel>& pixels, const DepthImage& depth_m,
            const CameraIntrinsics& camera, const Pose& T_world_camera,
            const FeatureGridView& features);

  int Dim() const;
  std::int64_t Size() const;               ///< feature-bearing voxels
  std::span<const VoxelKey> Keys() const;  ///< row order: order of first observation
  float WeightAt(std::int64_t row) const;
  std::vector<float> FeatureAt(std::int64_t row) const;
  std::optional<std::int64_t> RowOf(const VoxelKey& key) const;
  /// Camera position of the row's best view (largest frame confidence).
  Vector3f BestViewOf(std::int64_t row) const;
  float BestConfidenceOf(std::int64_t row) const;
  std::int64_t Bytes() const;
  MemoryCounters Counters() const;
  const FusionConfig& config() const;
  double VoxelSize() const;  ///< [m]

  /// Saved form of a row, and its restoration as the last row. The key must be new; the feature
  /// must have Dim() finite numbers.
  MemoryRow RowAt(std::int64_t row) const;
  void AppendRow(const MemoryRow& row);

  /// No row weighs more than `most`, so that new observations soon outweigh old ones.
  void LimitWeights(float most);
  /// Row i becomes the former row order[i]; `order` is a permutation of all rows.
  void ReorderRows(std::span<const std::int64_t> order);
  /// Adds the dropped rows of a saved memory to the counter.
  void AddDropped(std::int64_t rows);

  /// Cosine of every row with `text` (any norm > 0), in row order (eq:supp_similarity).
  std::vector<float> Similarity(std::span<const float> text) const;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::memory
