// SPDX-License-Identifier: MIT
#include "crossnav/geometry/grazing.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdlib>
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
constexpr double kNear_m = 0.01;       // chosen: what is nearer may be seen anywhere

/// Two neighbouring pixels whose end voxels do not share a face: (u, v) and the one to the right of
/// it, or below it.
struct PixelGap {
  int u = 0, v = 0;
  bool is_column = false;
};

/// Inverse depth of a pixel, NaN outside the image or where it says nothing.
double InverseDepth(const DepthFrame& frame, int u, int v) {
  if (!frame.depth_m.Contains(u, v)) return std::nan("");
  const float z = frame.depth_m.At(u, v);
  return z > 0 && z < kFarthest_m ? 1.0 / z : std::nan("");
}

/// Of a gap's line of pixels, from two before it to two after it: 0 and 1 are its own.
class PixelLine {
 public:
  PixelLine(const DepthFrame& frame, const PixelGap& gap, double voxel_m)
      : frame_(frame), gap_(gap), voxel_m_(voxel_m) {}

  double InverseAt(int i) const {
    return InverseDepth(frame_, gap_.u + (gap_.is_column ? 0 : i),
                        gap_.v + (gap_.is_column ? i : 0));
  }
  /// The point seen `t` pixels after the gap's first, at that inverse depth [voxels].
  Vector3d PointAt(double t, double inverse_depth) const {
    return BackProjectToVoxels(frame_.camera, frame_.T_world_camera,
                               gap_.u + (gap_.is_column ? 0 : t), gap_.v + (gap_.is_column ? t : 0),
                               1 / inverse_depth, voxel_m_);
  }

 private:
  const DepthFrame& frame_;
  const PixelGap& gap_;
  double voxel_m_;
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
    for (int corner = 1; corner < 7; ++corner) {
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

/// Pixels by whose rays some contested voxel may be seen, and those beside them: a gap's segments
/// lie between its rays, so that other gaps have nothing to spare.
class GapPixels {
 public:
  static constexpr int kWordPixels = 64;

  GapPixels(const DepthFrame& frame, const std::vector<VoxelKey>& contested, double voxel_m)
      : width_(frame.depth_m.width),
        height_(frame.depth_m.height),
        words_((width_ + kWordPixels - 1) / kWordPixels) {
    bits_.resize(static_cast<std::size_t>(words_) * height_);
    const Pose T_camera_world = frame.T_world_camera.inverse();
    for (const VoxelKey& key : contested) Add(RectOf(frame.camera, T_camera_world, key, voxel_m));
  }

  void Add(const PixelRect& rect) {
    if (rect.empty()) return;
    for (int v = rect.v0; v <= rect.v1; ++v)
      for (int word = rect.u0 / kWordPixels; word <= rect.u1 / kWordPixels; ++word) {
        const int from = std::max(rect.u0 - word * kWordPixels, 0);
        const int to = std::min(rect.u1 - word * kWordPixels, kWordPixels - 1);
        bits_[static_cast<std::size_t>(v) * words_ + word] |=
            ~std::uint64_t{0} << from & ~std::uint64_t{0} >> (kWordPixels - 1 - to);
      }
  }

  int words() const { return words_; }
  PixelRect All() const { return {0, 0, width_ - 1, height_ - 1}; }
  RowSpan PixelsOf(int word) const {
    return {word * kWordPixels, std::min((word + 1) * kWordPixels, width_)};
  }
  bool Any(int word, int v) const { return v >= 0 && WordOf(word, v) != 0; }
  bool Test(int u, int v) const {
    return (WordOf(u / kWordPixels, v) >> (u % kWordPixels) & 1) != 0;
  }

 private:
  std::uint64_t WordOf(int word, int v) const {
    return bits_[static_cast<std::size_t>(v) * words_ + word];
  }

  /// First pixels of gaps that the voxel's picture touches: on it, or one before it.
  PixelRect RectOf(const CameraIntrinsics& K, const Pose& T_camera_world, const VoxelKey& key,
                   double voxel_m) const {
    double left = width_, top = height_, right = -1, bottom = -1;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d p_camera =
          T_camera_world * (voxel_m * Vector3d(key.x + (corner & 1), key.y + (corner >> 1 & 1),
                                               key.z + (corner >> 2)));
      if (p_camera.z() < kNear_m) return All();
      const double u = K.cx + K.fx * p_camera.x() / p_camera.z();
      const double v = K.cy + K.fy * p_camera.y() / p_camera.z();
      left = std::min(left, u), right = std::max(right, u);
      top = std::min(top, v), bottom = std::max(bottom, v);
    }
    const auto from = [](double px, int size) {
      return static_cast<int>(std::ceil(std::clamp<double>(px - 1 - kRounding_px, 0, size)));
    };
    const auto to = [](double px, int size) {
      return static_cast<int>(std::floor(std::clamp<double>(px + kRounding_px, -1, size - 1)));
    };
    return {from(left, width_), from(top, height_), to(right, width_), to(bottom, height_)};
  }

  int width_, height_, words_;
  std::vector<std::uint64_t> bits_;
};

/// The gaps at such pixels.
class GapFinder {
 public:
  GapFinder(const DepthFrame& frame, const MapConfig& config, const GapPixels& where)
      : frame_(frame), config_(config), where_(where), reach_m_(frame.depth_m.width) {
    row_.Resize(frame.depth_m.width);
    above_.Resize(frame.depth_m.width);
  }

  /// Calls visit(gap, a, b) with the end voxels of both pixels; x is kNoEnd where there is none.
  template <class F>
  void ForEach(F&& visit) {
    for (int v = 0; v < frame_.depth_m.height; ++v) {
      ComputeNeeded(v);
      for (int word = 0; word < where_.words(); ++word) {
        RowSpan pixels = where_.PixelsOf(word);
        if (where_.Any(word, v - 1)) VisitApart(above_, pixels, v - 1, true, visit);
        pixels.end = std::min(pixels.end, frame_.depth_m.width - 1);
        if (where_.Any(word, v)) VisitApart(row_, pixels, v, false, visit);
      }
      std::swap(row_, above_);
    }
  }

 private:
  bool IsNeeded(int word, int v) const { return where_.Any(word, v) || where_.Any(word, v - 1); }

  /// The row's end voxels at the words that are asked of, in it or above, and one pixel more.
  void ComputeNeeded(int v) {
    KeyBounds unused{};
    for (int word = 0; word < where_.words(); ++word) {
      if (!IsNeeded(word, v)) continue;
      RowSpan span = where_.PixelsOf(word);
      while (word + 1 < where_.words() && IsNeeded(word + 1, v))
        span.end = where_.PixelsOf(++word).end;
      span.end = std::min(span.end + 1, frame_.depth_m.width);
      ComputeEnds(frame_, config_, v, span, &row_, reach_m_.data(), &unused);
    }
  }

  /// Between `from`, which is row v, and the pixels beside it or, in row_, below it.
  template <class F>
  void VisitApart(const RowEnds& from, RowSpan pixels, int v, bool is_column, F& visit) {
    const auto key = [](const RowEnds& ends, int u) {
      return VoxelKey{ends.x[u], ends.y[u], ends.z[u]};
    };
    const int shift = is_column ? 0 : 1;
    const int count = FindApart(pixels, from, row_, shift, apart_.data());
    for (int i = 0; i < count; ++i) {
      const int u = apart_[i];
      if (where_.Test(u, v)) visit(PixelGap{u, v, is_column}, key(from, u), key(row_, u + shift));
    }
  }

  const DepthFrame& frame_;
  const MapConfig& config_;
  const GapPixels& where_;
  RowEnds row_, above_;
  std::vector<float> reach_m_;
  std::array<std::int32_t, GapPixels::kWordPixels> apart_{};
};

}  // namespace

void SpareSurfacesInGaps(MapData& map, const DepthFrame& frame, GapSearch search) {
  const Contested contested(map);
  if (contested.keys().empty()) return;
  GridCursor<VoxelBlock> cursor(map.grid);
  const auto spare = [&](const Vector3d& a_vox, const Vector3d& b_vox) {
    WalkRay(a_vox, b_vox, [&](const VoxelKey& key) {
      if (!contested.Maybe(key)) return true;
      VoxelBlock* block = cursor.Find(key);
      if (block != nullptr && block->hit.Test(CellIndexOf(key)))
        block->frame_free.Reset(CellIndexOf(key));
      return true;
    });
  };
  GapPixels where(frame, contested.keys(), map.config.voxel_m);
  if (search == GapSearch::kEverywhere) where.Add(where.All());
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
