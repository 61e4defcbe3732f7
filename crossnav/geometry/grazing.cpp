// SPDX-License-Identifier: MIT
#include "crossnav/geometry/grazing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {
namespace {

// chosen: on a plane the inverse depth is linear over the image; steps from pixel to pixel may
// differ by this share. At an edge in depth the steps on both sides are near zero against that of
// the edge.
constexpr double kBend = 0.5;
constexpr double kFarthest_m = 1000;   // chosen: what is farther is no surface of a house
constexpr double kRounding_px = 0.01;  // chosen: far above that of a projection
constexpr double kRounding = 1e-6;     // chosen: of a depth, far above that of its computation
constexpr double kNear_m = 0.01;       // chosen: what is nearer may be seen anywhere

/// Two neighbouring pixels whose end voxels do not share a face: (u, v) and the one to the right of
/// it, or below it.
struct PixelGap {
  int u = 0, v = 0;
  bool is_column = false;
};

/// Inverse depth, NaN where a pixel says nothing.
double InverseOf(float depth_m) {
  return depth_m > 0 && depth_m < kFarthest_m ? 1.0 / depth_m : std::nan("");
}

/// Of a gap's line of pixels, from two before it to two after it: 0 and 1 are its own.
class PixelLine {
 public:
  PixelLine(const DepthFrame& frame, const PixelGap& gap, double voxel_m)
      : frame_(frame), gap_(gap), voxel_m_(voxel_m) {
    const int width = frame.depth_m.width, at = gap.is_column ? gap.v : gap.u;
    const int step = gap.is_column ? width : 1;
    const int size = gap.is_column ? frame.depth_m.height : width;
    const float* depth_m = &frame.depth_m.At(gap.u, gap.v);
    for (int i = kFirst; i <= kLast; ++i)
      inverse_[i - kFirst] = at + i >= 0 && at + i < size
                                 ? InverseOf(depth_m[static_cast<std::ptrdiff_t>(i) * step])
                                 : std::nan("");
  }

  /// NaN outside the image or where the pixel says nothing.
  double InverseAt(int i) const { return inverse_[i - kFirst]; }

  /// The point seen `t` pixels after the gap's first, at that inverse depth [voxels].
  Vector3d PointAt(double t, double inverse_depth) const {
    return BackProjectToVoxels(frame_.camera, frame_.T_world_camera,
                               gap_.u + (gap_.is_column ? 0 : t), gap_.v + (gap_.is_column ? t : 0),
                               1 / inverse_depth, voxel_m_);
  }

 private:
  static constexpr int kFirst = -2, kLast = 3;
  const DepthFrame& frame_;
  const PixelGap& gap_;
  double voxel_m_;
  std::array<double, kLast - kFirst + 1> inverse_{};
};

bool IsSameSlope(double step, double other) {
  return std::abs(step - other) <= kBend * std::abs(step);
}

/// The surface seen at pixel `from` and, going away from the gap, before it, goes on into the gap
/// as a plane: on to the next ray, which ends in front of it, or to `depth_max_m`. Visits the
/// segment.
template <class F>
void ContinuePlane(const PixelLine& line, int from, double depth_max_m, F&& visit) {
  const int away = from == 0 ? -1 : 1;
  const double here = line.InverseAt(from), next = line.InverseAt(from - away);
  const double step = here - line.InverseAt(from + away);
  const double step_before = line.InverseAt(from + away) - line.InverseAt(from + 2 * away);
  if (!IsSameSlope(step, step_before) || !(step < 0)) return;  // false with NaN
  if (next < here + step) return;                              // sees beyond the plane
  const double t = std::min(1.0, (1 / depth_max_m - here) / step);
  if (t > 0) visit(line.PointAt(from, here), line.PointAt(from - away * t, here + step * t));
}

/// Calls visit(a, b) for the segments of surface in the gap [voxels].
template <class F>
void ForEachSegment(const PixelLine& line, bool is_wide, double depth_max_m, F&& visit) {
  const double first = line.InverseAt(0), second = line.InverseAt(1);
  const double here = second - first;
  const bool is_plane = !is_wide || IsSameSlope(here, first - line.InverseAt(-1)) ||
                        IsSameSlope(here, line.InverseAt(2) - second);
  if (is_plane && !std::isnan(here)) {
    visit(line.PointAt(0, first), line.PointAt(1, second));
    return;
  }
  ContinuePlane(line, 0, depth_max_m, visit);
  ContinuePlane(line, 1, depth_max_m, visit);
}

/// Occupied voxels that the frame passed, few of all: what is not among them needs no look at the
/// map. By hash; a false "maybe" costs that look.
class Contested {
 public:
  explicit Contested(const MapData& map) {
    for (const GridEntry* entry : map.frame) {
      const VoxelBlock& block = entry->block;
      ForEachCell(block.hit & block.frame_free & ~block.frame_hit, [&](int cell) {
        keys_.push_back(KeyInBlock(entry->key, cell));
        bits_[HashOf(keys_.back())] = true;
      });
    }
  }
  const std::vector<VoxelKey>& keys() const { return keys_; }
  bool Maybe(const VoxelKey& key) const { return bits_[HashOf(key)]; }
  /// Of the voxels between two that touch.
  bool MaybeBetween(const VoxelKey& first, const VoxelKey& step) const {
    const int along = (step.x != 0 ? 1 : 0) | (step.y != 0 ? 2 : 0) | (step.z != 0 ? 4 : 0);
    for (int corner = (along - 1) & along; corner != 0; corner = (corner - 1) & along) {
      if (Maybe(first + VoxelKey{(corner & 1) != 0 ? step.x : 0, (corner & 2) != 0 ? step.y : 0,
                                 (corner & 4) != 0 ? step.z : 0}))
        return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kBits = 1 << 16;  // chosen: in the first cache, mostly empty
  static std::size_t HashOf(const VoxelKey& key) {
    const auto mixed = static_cast<std::uint32_t>(key.x) * 73856093U ^
                       static_cast<std::uint32_t>(key.y) * 19349663U ^
                       static_cast<std::uint32_t>(key.z) * 83492791U;
    return (mixed ^ mixed >> 16) % kBits;
  }
  std::vector<VoxelKey> keys_;
  std::bitset<kBits> bits_;
};

/// A voxel in the image: the first pixels of gaps that its picture touches, on it or one before it,
/// and up to which depth it reaches [m].
struct Sighting {
  PixelRect rect;
  float depth_m = 0;
};

/// Pixels by whose rays some contested voxel may be seen, and those beside them: a gap's segments
/// lie between its rays, so that other gaps have nothing to spare.
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
  /// Surfaces in a gap begin at the nearer of its pixels or farther: drops pixels whose gaps lie
  /// behind all that may be seen there.
  void DropFar(const DepthView& view) {
    for (int v = 0; v < height_; ++v)
      for (int i = 0; i < words_; ++i) {
        Word& word = words_of_rows_[static_cast<std::size_t>(v) * words_ + i];
        if (word.bits != 0)
          word.bits = FindNear({i * kWordPixels, word.bits}, view.Row(v),
                               view.Row(std::min(v + 1, height_ - 1)), word.farthest_m);
      }
  }

  /// Row -1 has none.
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
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d p_camera =
          T_camera_world * (voxel_m * Vector3d(key.x + (corner & 1), key.y + (corner >> 1 & 1),
                                               key.z + (corner >> 2)));
      if (p_camera.z() < kNear_m) return Everything();
      const double u = K.cx + K.fx * p_camera.x() / p_camera.z();
      const double v = K.cy + K.fy * p_camera.y() / p_camera.z();
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

/// From the first to the last of these pixels, of which there are some.
RowSpan SpanOf(const PixelWord& pixels) {
  return {pixels.first + std::countr_zero(pixels.bits),
          pixels.first + static_cast<int>(std::bit_width(pixels.bits))};
}

/// The gaps at such pixels.
class GapFinder {
 public:
  GapFinder(const DepthFrame& frame, const MapConfig& config, const GapPixels& where)
      : frame_(frame), config_(config), where_(where), unused_reach_m_(frame.depth_m.width) {
    row_.Resize(frame.depth_m.width);
    above_.Resize(frame.depth_m.width);
  }

  /// Calls visit(gap, a, b) with the end voxels of both pixels; x is kNoEnd where there is none.
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
  /// All but the image's last column, to the right of which is none.
  std::uint64_t NotLast(int word) const {
    const int last = frame_.depth_m.width - 1 - word * GapPixels::kWordPixels;
    return last < GapPixels::kWordPixels ? ~(std::uint64_t{1} << last) : ~std::uint64_t{0};
  }

  /// The row's end voxels at the pixels that are asked of, in it or above, and one pixel more.
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
      visit(PixelGap{u, v, is_column}, key(from, u), key(row_, u + shift));
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
  GridCursor<VoxelBlock> cursor(map.grid);
  GapPixels where(frame, contested.keys(), map.config.voxel_m);
  const auto spare = [&](const Vector3d& a_vox, const Vector3d& b_vox) {
    WalkRay(a_vox, b_vox, [&](const VoxelKey& key) {
      if (!contested.Maybe(key)) return true;
      VoxelBlock* block = cursor.Find(key);
      if (block != nullptr && block->hit.Test(CellIndexOf(key)))
        block->frame_free.Reset(CellIndexOf(key));
      return true;
    });
  };
  if (search == GapSearch::kEverywhere)
    where.Add(where.Everything());
  else
    where.DropFar(map.view);
  const auto look_into = [&](const PixelGap& gap, const VoxelKey& a, const VoxelKey& b) {
    const bool is_a = a.x != kNoEnd, is_b = b.x != kNoEnd;
    if (!is_a && !is_b) return;
    const VoxelKey step = is_a && is_b ? b - a : VoxelKey{};
    const bool is_wide =
        !is_a || !is_b || std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)}) > 1;
    if (!is_wide && !contested.MaybeBetween(a, step)) return;
    ForEachSegment(PixelLine(frame, gap, map.config.voxel_m), is_wide, map.config.depth_max_m,
                   spare);
  };
  GapFinder(frame, map.config, where).ForEach(look_into);
}

}  // namespace crossnav::geometry
