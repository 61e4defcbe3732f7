// SPDX-License-Identifier: MIT
#include "crossnav/geometry/grazing.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstdlib>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {
namespace {

// chosen: on a plane the inverse depth is linear over the image; steps from pixel to pixel may
// differ by this share. At an edge in depth the steps on both sides are near zero against that of
// the edge.
constexpr double kBend = 0.5;
constexpr double kFarthest_m = 1000;  // chosen: what is farther is no surface of a house

/// Of two voxels that share no face, or one of which is missing (both are: no gap).
void AddGap(MapData& map, const RowEnds& a, int ua, const RowEnds& b, int ub, PixelGap gap) {
  const bool is_a = a.x[ua] != kNoEnd, is_b = b.x[ub] != kNoEnd;
  if (!is_a && !is_b) return;
  gap.is_wide = true;
  if (is_a && is_b) {
    const VoxelKey first{a.x[ua], a.y[ua], a.z[ua]};
    const VoxelKey step = VoxelKey{b.x[ub], b.y[ub], b.z[ub]} - first;
    gap.is_wide = std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)}) > 1;
    gap.first = first;
    gap.step = step;
  }
  map.gaps.push_back(gap);
}

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
      ForEachCell(entry->block.hit & entry->block.frame_free,
                  [&](int cell) { bits_[HashOf(KeyInBlock(entry->key, cell))] = true; });
    }
  }
  bool Maybe(const VoxelKey& key) const { return bits_[HashOf(key)]; }
  bool MaybeBetween(const PixelGap& gap) const {
    for (int corner = 1; corner < 7; ++corner) {
      if (Maybe(gap.first + VoxelKey{(corner & 1) != 0 ? gap.step.x : 0,
                                     (corner & 2) != 0 ? gap.step.y : 0,
                                     (corner & 4) != 0 ? gap.step.z : 0}))
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
  std::bitset<kBits> bits_;
};

}  // namespace

void FindGaps(MapData& map, int v, int width, const RowEnds& row, const RowEnds* above) {
  map.apart_pixels.resize(row.starts.size());
  const int across = FindApart(width, row, row, 1, map.apart_pixels.data());
  for (int i = 0; i < across; ++i) {
    const int u = map.apart_pixels[i];
    AddGap(map, row, u, row, u + 1, PixelGap(u, v, false));
  }
  if (above == nullptr) return;
  const int down = FindApart(width, *above, row, 0, map.apart_pixels.data());
  for (int i = 0; i < down; ++i) {
    const int u = map.apart_pixels[i];
    AddGap(map, *above, u, row, u, PixelGap(u, v - 1, true));
  }
}

void SpareSurfacesInGaps(MapData& map, const DepthFrame& frame) {
  if (map.gaps.empty()) return;
  const Contested contested(map);
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
  for (const PixelGap& gap : map.gaps) {
    if (!gap.is_wide && !contested.MaybeBetween(gap)) continue;
    ForEachSegment(PixelLine(frame, gap, map.config.voxel_m), gap.is_wide, map.config.depth_max_m,
                   spare);
  }
}

}  // namespace crossnav::geometry
