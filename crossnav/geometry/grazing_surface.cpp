// SPDX-License-Identifier: MIT
#include "crossnav/geometry/grazing_surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "crossnav/geometry/grazing_surface_simd.h"

namespace crossnav::geometry {
namespace {

constexpr double kRounding_px = 0.01;  // chosen: far above that of a projection
constexpr double kRounding = 1e-6;     // chosen: of a depth, far above that of its computation
constexpr double kNear_m = 0.01;       // chosen: a nearer voxel may appear at any pixel

/// Hash set of the few occupied voxels that the frame passed. Voxels outside need no map lookup; a
/// false positive costs that lookup.
class Contested {
 public:
  explicit Contested(const MapData& map) {
    for (const GridEntry* entry : map.frame) {
      const VoxelBlock& block = entry->block;
      ForEachCell(block.hit & block.frame_free & ~block.frame_hit, [&](int cell) {
        keys_.push_back(KeyInBlock(entry->key, cell));
        hashes_.Insert(keys_.back());
      });
    }
  }
  const std::vector<VoxelKey>& keys() const { return keys_; }
  const VoxelHashes& hashes() const { return hashes_; }
  /// False only if no voxel of the set lies between two touching voxels.
  bool MaybeBetween(const VoxelKey& first, const VoxelKey& step) const {
    const int along = (step.x != 0 ? 1 : 0) | (step.y != 0 ? 2 : 0) | (step.z != 0 ? 4 : 0);
    for (int corner = (along - 1) & along; corner != 0; corner = (corner - 1) & along) {
      if (hashes_.Maybe(first + VoxelKey{(corner & 1) != 0 ? step.x : 0,
                                         (corner & 2) != 0 ? step.y : 0,
                                         (corner & 4) != 0 ? step.z : 0}))
        return true;
    }
    return false;
  }

 private:
  std::vector<VoxelKey> keys_;
  VoxelHashes hashes_;
};

/// Image footprint of a voxel: first pixels of the gaps that it touches, and its greatest depth
/// [m].
struct Sighting {
  PixelRect rect;
  float depth_m = 0;
};

/// Pixels that may show a contested voxel, and their neighbours. Segments of a gap lie between its
/// rays, so that no other gap can spare a voxel.
class GapPixels {
 public:
  static constexpr int kWordPixels = 64;

  GapPixels(const DepthFrame& frame, const std::vector<VoxelKey>& contested, double voxel_m)
      : width_(frame.depth_m.width),
        height_(frame.depth_m.height),
        words_((width_ + kWordPixels - 1) / kWordPixels),
        words_of_rows_(static_cast<std::size_t>(words_) * height_) {
    const Pose T_camera_world = frame.T_world_camera.inverse();
    for (const VoxelKey& key : contested) Add(See(frame.camera, T_camera_world, key, voxel_m));
  }

  void Add(const Sighting& seen) {
    const PixelRect& rect = seen.rect;
    if (rect.empty()) return;
    for (int v = rect.v0; v <= rect.v1; ++v)
      for (int i = rect.u0 / kWordPixels; i <= rect.u1 / kWordPixels; ++i) {
        const int from = std::max(rect.u0 - i * kWordPixels, 0);
        const int to = std::min(rect.u1 - i * kWordPixels, kWordPixels - 1);
        Word& word = words_of_rows_[static_cast<std::size_t>(v) * words_ + i];
        word.bits |= ~std::uint64_t{0} << from & ~std::uint64_t{0} >> (kWordPixels - 1 - to);
        word.farthest_m = std::max(word.farthest_m, seen.depth_m);
      }
  }

  int words() const { return words_; }
  Sighting Everything() const {
    return {{0, 0, width_ - 1, height_ - 1}, std::numeric_limits<float>::infinity()};
  }
  /// Drops pixels with gaps behind every contested voxel there: a surface in a gap begins at its
  /// nearer pixel or farther.
  void DropFar(const DepthView& view) {
    for (int v = 0; v < height_; ++v)
      for (int i = 0; i < words_; ++i) {
        Word& word = words_of_rows_[static_cast<std::size_t>(v) * words_ + i];
        if (word.bits != 0)
          word.bits = FindNear({i * kWordPixels, word.bits}, view.Row(v),
                               view.Row(std::min(v + 1, height_ - 1)), word.farthest_m);
      }
  }

  /// Row -1 is empty.
  PixelWord At(int word, int v) const {
    if (v < 0) return {};
    return {word * kWordPixels, words_of_rows_[static_cast<std::size_t>(v) * words_ + word].bits};
  }

 private:
  struct Word {
    std::uint64_t bits = 0;
    float farthest_m = 0;
  };

  Sighting See(const CameraIntrinsics& K, const Pose& T_camera_world, const VoxelKey& key,
               double voxel_m) const {
    double left = width_, top = height_, right = -1, bottom = -1, depth_m = 0;
    const Vector3d first = T_camera_world * (voxel_m * Vector3d(key.x, key.y, key.z));
    const Eigen::Matrix3d edges = voxel_m * T_camera_world.linear();
    for (int corner = 0; corner < 8; ++corner) {
      Vector3d p_camera = first;
      for (int a = 0; a < 3; ++a)
        if ((corner >> a & 1) != 0) p_camera += edges.col(a);
      if (p_camera.z() < kNear_m) return Everything();
      const double inverse = 1 / p_camera.z();
      const double u = K.cx + K.fx * p_camera.x() * inverse;
      const double v = K.cy + K.fy * p_camera.y() * inverse;
      left = std::min(left, u), right = std::max(right, u);
      top = std::min(top, v), bottom = std::max(bottom, v);
      depth_m = std::max(depth_m, p_camera.z());
    }
    const auto from = [](double px, int size) {
      return static_cast<int>(std::ceil(std::clamp<double>(px - 1 - kRounding_px, 0, size)));
    };
    const auto to = [](double px, int size) {
      return static_cast<int>(std::floor(std::clamp<double>(px + kRounding_px, -1, size - 1)));
    };
    return {{from(left, width_), from(top, height_), to(right, width_), to(bottom, height_)},
            static_cast<float>(depth_m * (1 + kRounding))};
  }

  int width_, height_, words_;
  std::vector<Word> words_of_rows_;
};

/// Range from the first to the last pixel; not empty.
RowSpan SpanOf(const PixelWord& pixels) {
  return {pixels.first + std::countr_zero(pixels.bits),
          pixels.first + static_cast<int>(std::bit_width(pixels.bits))};
}

/// Gaps at the selected pixels.
class GapFinder {
 public:
  GapFinder(const DepthFrame& frame, const MapConfig& config, const GapPixels& where)
      : frame_(frame), config_(config), where_(where), unused_reach_m_(frame.depth_m.width) {
    row_.Resize(frame.depth_m.width);
    above_.Resize(frame.depth_m.width);
  }

  /// Calls visit(u, v, is_column, a, b) with a gap's first pixel and both end voxels; x is kNoEnd
  /// for a missing end.
  template <class F>
  void ForEach(F&& visit) {
    for (int v = 0; v < frame_.depth_m.height; ++v) {
      ComputeNeeded(v);
      for (int word = 0; word < where_.words(); ++word) {
        const PixelWord above = where_.At(word, v - 1);
        if (above.bits != 0) VisitApart(above, above_, v - 1, true, visit);
        PixelWord here = where_.At(word, v);
        here.bits &= NotLast(word);
        if (here.bits != 0) VisitApart(here, row_, v, false, visit);
      }
      std::swap(row_, above_);
    }
  }

 private:
  /// All but the image's last column, which has no right neighbour.
  std::uint64_t NotLast(int word) const {
    const int last = frame_.depth_m.width - 1 - word * GapPixels::kWordPixels;
    return last < GapPixels::kWordPixels ? ~(std::uint64_t{1} << last) : ~std::uint64_t{0};
  }

  /// End voxels of the row at the selected pixels of this row and the row above, and one pixel
  /// more.
  void ComputeNeeded(int v) {
    RowSpan span;
    for (int word = 0; word < where_.words(); ++word) {
      PixelWord pixels = where_.At(word, v);
      pixels.bits |= where_.At(word, v - 1).bits;
      if (pixels.bits == 0) continue;
      const RowSpan more = SpanOf(pixels);
      if (more.first > span.end) {
        Compute(span, v);
        span = more;
      }
      span.end = std::min(more.end + 1, frame_.depth_m.width);
    }
    Compute(span, v);
  }
  void Compute(RowSpan span, int v) {
    if (span.first >= span.end) return;
    span.end += (span.first - span.end) & (kRowEndsPad - 1);  // whole vectors
    span.end = std::min(span.end, frame_.depth_m.width);
    KeyBounds unused{};
    ComputeEnds(frame_, config_, v, span, &row_, unused_reach_m_.data(), &unused);
  }

  /// Between `from`, which is row v, and the pixels beside it or, in row_, below it.
  template <class F>
  void VisitApart(const PixelWord& pixels, const RowEnds& from, int v, bool is_column, F& visit) {
    const auto key = [](const RowEnds& ends, int u) {
      return VoxelKey{ends.x[u], ends.y[u], ends.z[u]};
    };
    const int shift = is_column ? 0 : 1;
    const int count = FindApart(pixels, from, row_, shift, apart_.data());
    for (int i = 0; i < count; ++i) {
      const int u = apart_[i];
      visit(u, v, is_column, key(from, u), key(row_, u + shift));
    }
  }

  const DepthFrame& frame_;
  const MapConfig& config_;
  const GapPixels& where_;
  RowEnds row_, above_;
  std::vector<float> unused_reach_m_;
  std::array<std::int32_t, GapPixels::kWordPixels + kRowEndsPad> apart_{};
};

}  // namespace

void SpareSurfacesInGaps(MapData& map, const DepthFrame& frame, GapSearch search) {
  const Contested contested(map);
  if (contested.keys().empty()) return;
  GapPixels where(frame, contested.keys(), map.config.voxel_m);
  if (search == GapSearch::kEverywhere)
    where.Add(where.Everything());
  else
    where.DropFar(map.view);
  Gaps gaps;
  Segments segments;
  std::vector<VoxelKey> met;
  const auto look_into = [&] {
    FindSegments(frame, map.config, gaps, &segments);
    WalkSegments(segments, contested.hashes(), &met);
    gaps.count = 0;
  };
  GapFinder(frame, map.config, where)
      .ForEach([&](int u, int v, bool is_column, const VoxelKey& a, const VoxelKey& b) {
        const bool is_a = a.x != kNoEnd, is_b = b.x != kNoEnd;
        if (!is_a && !is_b) return;
        const VoxelKey step = is_a && is_b ? b - a : VoxelKey{};
        const bool is_wide =
            !is_a || !is_b || std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)}) > 1;
        if (!is_wide && !contested.MaybeBetween(a, step)) return;
        if (gaps.count == Gaps::kRoom) look_into();
        gaps.Add(u, v, is_column, is_wide);
      });
  look_into();
  GridCursor<VoxelBlock> cursor(map.grid);
  for (const VoxelKey& key : met) {
    VoxelBlock* block = cursor.Find(key);
    if (block != nullptr && block->hit.Test(CellIndexOf(key)))
      block->frame_free.Reset(CellIndexOf(key));
  }
}

}  // namespace crossnav::geometry
