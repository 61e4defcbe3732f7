// SPDX-License-Identifier: MIT
#include "crossnav/geometry/grazing_surface_simd.h"

#include <bit>
#include <limits>

// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/geometry/grazing_surface_simd.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                          // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crossnav::geometry::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using Index = hn::Rebind<std::int32_t, D>;
using Depth = hn::Rebind<float, D>;
using Hash = hn::Rebind<std::uint32_t, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using Points = std::array<std::array<double, Segments::kRoom>, 3>;

// chosen: steps of the inverse depth from pixel to pixel may differ by this share on a plane. At an
// edge in depth the steps on both sides are near zero against that of the edge.
constexpr double kBend = 0.5;
constexpr double kFarthest_m = 1000;   // chosen: no surface of a house is farther
constexpr double kMost_vox = 1 << 30;  // chosen: half the range of VoxelKey

HWY_INLINE V Set(double x) {
  return hn::Set(D(), x);
}

// Where the lines of pixels of some gaps begin.
struct Lines {
  V u, v;
  M is_column;
  hn::Vec<Index> pixel, step;  // index in the image; offset to the next pixel of the line
  V at, size;                  // index in the image's row or column; length of that
};

HWY_INLINE Lines LinesOf(const DepthImage& depth_m, const Gaps& gaps, int first) {
  const D d;
  const Index di;
  const auto u = hn::LoadU(di, &gaps.u[first]), v = hn::LoadU(di, &gaps.v[first]);
  const auto column = hn::LoadU(di, &gaps.is_column[first]);
  const auto width = hn::Set(di, depth_m.width), one = hn::Set(di, 1);
  Lines lines;
  lines.u = hn::PromoteTo(d, u);
  lines.v = hn::PromoteTo(d, v);
  lines.is_column = hn::Ne(hn::PromoteTo(d, column), hn::Zero(d));
  lines.pixel = hn::Add(hn::Mul(v, width), u);
  lines.step = hn::Add(one, hn::Mul(column, hn::Sub(width, one)));
  lines.at = hn::IfThenElse(lines.is_column, lines.v, lines.u);
  lines.size = hn::IfThenElse(lines.is_column, Set(depth_m.height), Set(depth_m.width));
  return lines;
}

// The inverse depth of pixel `i` of the lines, 0 and 1 being the gap's own; NaN outside the image
// or for invalid pixels.
HWY_INLINE V InverseAt(const DepthImage& depth_m, const Lines& lines, int i) {
  const D d;
  const Index di;
  const auto pixel = hn::Add(lines.pixel, hn::Mul(lines.step, hn::Set(di, i)));
  const auto last = hn::Set(di, depth_m.width * depth_m.height - 1);
  const V z_m = hn::PromoteTo(d, hn::GatherIndex(Depth(), depth_m.data.data(),
                                                 hn::Min(hn::Max(pixel, hn::Zero(di)), last)));
  const V at = hn::Add(lines.at, Set(i));
  const M is_inside = hn::And(hn::Ge(at, hn::Zero(d)), hn::Lt(at, lines.size));
  const M is_seen = hn::And(hn::Gt(z_m, hn::Zero(d)), hn::Lt(z_m, Set(kFarthest_m)));
  return hn::IfThenElse(hn::And(is_inside, is_seen), hn::Div(Set(1), z_m),
                        Set(std::numeric_limits<double>::quiet_NaN()));
}

HWY_INLINE unsigned BitsOf(M mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(D(), mask, bytes.data());
  return bytes[0];
}

// Image point `t` pixels after the gap's first pixel at that inverse depth, as (u, v, inverse
// depth); appends the lanes `kept` to `out` from index `n` on.
HWY_INLINE void Store(const Lines& lines, V t, V inverse_depth, unsigned kept, Points* out, int n) {
  const D d;
  alignas(64) double u[8], v[8], inverse[8];
  hn::Store(hn::Add(lines.u, hn::IfThenZeroElse(lines.is_column, t)), d, u);
  hn::Store(hn::Add(lines.v, hn::IfThenElseZero(lines.is_column, t)), d, v);
  hn::Store(inverse_depth, d, inverse);
  for (; kept != 0; kept &= kept - 1, ++n) {  // Compress of double is slow or emulated
    const int lane = std::countr_zero(kept);
    (*out)[0][n] = u[lane];
    (*out)[1][n] = v[lane];
    (*out)[2][n] = inverse[lane];
  }
}

HWY_INLINE M IsSameSlope(V step, V other) {
  return hn::Le(hn::Abs(hn::Sub(step, other)), hn::Mul(Set(kBend), hn::Abs(step)));
}

// Inverse depths along the lines, going away from the gap on one side of it.
struct Side {
  V across, here, before, before_that;
  double first, towards;  // the place of `here`, and the step into the gap
};

// Planes seen on one side extend into the gap: to the next ray that ends in front of them, or to
// `depth_max_m`.
HWY_INLINE void ContinuePlanes(const Lines& lines, const Side& side, double depth_max_m, M asked,
                               Segments* out) {
  const D d;
  const V step = hn::Sub(side.here, side.before);
  const V step_before = hn::Sub(side.before, side.before_that);
  const M is_plane = hn::And(IsSameSlope(step, step_before), hn::Lt(step, hn::Zero(d)));
  const M sees_beyond = hn::Lt(side.across, hn::Add(side.here, step));  // false with NaN
  const V to_limit = hn::Div(hn::Sub(Set(1 / depth_max_m), side.here), step);
  const V t = hn::IfThenElse(hn::Lt(to_limit, Set(1)), to_limit, Set(1));
  const unsigned kept =
      BitsOf(hn::And(hn::AndNot(sees_beyond, hn::And(asked, is_plane)), hn::Gt(t, hn::Zero(d))));
  if (kept == 0) return;
  Store(lines, Set(side.first), side.here, kept, &out->a, out->count);
  Store(lines, hn::Add(Set(side.first), hn::Mul(Set(side.towards), t)),
        hn::Add(side.here, hn::Mul(step, t)), kept, &out->b, out->count);
  out->count += std::popcount(kept);
}

// From (u, v, inverse depth), in place.
void BackProject(const DepthFrame& frame, double voxel_m, int count, Points* points) {
  const D d;
  const CameraIntrinsics& K = frame.camera;
  const auto& T = frame.T_world_camera.matrix();
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const V u = hn::LoadU(d, &(*points)[0][i]), v = hn::LoadU(d, &(*points)[1][i]);
    const V z = hn::Div(Set(1), hn::LoadU(d, &(*points)[2][i]));
    const V x = hn::Div(hn::Mul(hn::Sub(u, Set(K.cx)), z), Set(K.fx));
    const V y = hn::Div(hn::Mul(hn::Sub(v, Set(K.cy)), z), Set(K.fy));
    for (int a = 0; a < 3; ++a) {
      const V xy = hn::Add(hn::Mul(Set(T(a, 0)), x), hn::Mul(Set(T(a, 1)), y));
      const V p_m = hn::Add(hn::Add(xy, hn::Mul(Set(T(a, 2)), z)), Set(T(a, 3)));
      hn::StoreU(hn::Div(p_m, Set(voxel_m)), d, &(*points)[a][i]);
    }
  }
}

void FindSegmentsLanes(const DepthFrame& frame, const MapConfig& config, const Gaps& gaps,
                       Segments* out) {
  const D d;
  const DepthImage& depth_m = frame.depth_m;
  out->count = 0;
  for (int i = 0; i < gaps.count; i += static_cast<int>(hn::Lanes(d))) {
    const Lines lines = LinesOf(depth_m, gaps, i);
    const M asked = hn::FirstN(d, static_cast<std::size_t>(gaps.count - i));
    const M is_wide = hn::Ne(hn::PromoteTo(d, hn::LoadU(Index(), &gaps.is_wide[i])), hn::Zero(d));
    const V before = InverseAt(depth_m, lines, -1), first = InverseAt(depth_m, lines, 0);
    const V second = InverseAt(depth_m, lines, 1), after = InverseAt(depth_m, lines, 2);
    const V here = hn::Sub(second, first);
    const M is_plane = hn::Or(IsSameSlope(here, hn::Sub(first, before)),
                              IsSameSlope(here, hn::Sub(after, second)));
    const M is_seen = hn::Eq(here, here);
    const M whole = hn::And(asked, hn::And(is_seen, hn::Or(hn::Not(is_wide), is_plane)));
    if (const unsigned kept = BitsOf(whole); kept != 0) {
      Store(lines, Set(0), first, kept, &out->a, out->count);
      Store(lines, Set(1), second, kept, &out->b, out->count);
      out->count += std::popcount(kept);
    }
    const M parted = hn::AndNot(whole, asked);
    const Side left{second, first, before, InverseAt(depth_m, lines, -2), 0, 1};
    const Side right{first, second, after, InverseAt(depth_m, lines, 3), 1, -1};
    ContinuePlanes(lines, left, config.depth_max_m, parted, out);
    ContinuePlanes(lines, right, config.depth_max_m, parted, out);
  }
  BackProject(frame, config.voxel_m, out->count, &out->a);
  BackProject(frame, config.voxel_m, out->count, &out->b);
}

// State of WalkRay for a vector of segments.
struct Walkers {
  V start[3], cell[3], last[3], step[3], up[3], inverse[3];

  HWY_INLINE Walkers(const Segments& segments, int first) {
    const D d;
    for (int a = 0; a < 3; ++a) {
      start[a] = hn::LoadU(d, &segments.a[a][first]);
      const V end = hn::LoadU(d, &segments.b[a][first]);
      cell[a] = hn::Floor(start[a]);
      last[a] = hn::Floor(end);
      const M is_up = hn::Gt(last[a], cell[a]);
      step[a] = hn::IfThenElse(is_up, Set(1), Set(-1));
      up[a] = hn::IfThenElseZero(is_up, Set(1));
      inverse[a] = hn::Div(Set(1), hn::Sub(end, start[a]));
    }
  }

  // False for segments whose endpoints overflow VoxelKey; their walk would not end.
  HWY_INLINE M IsInReach() const {
    V sum = hn::Zero(D());  // of absolute values, so that a NaN makes the comparison false
    for (int a = 0; a < 3; ++a) sum = hn::Add(sum, hn::Add(hn::Abs(cell[a]), hn::Abs(last[a])));
    return hn::Lt(sum, Set(kMost_vox));
  }

  HWY_INLINE M IsWalking() const {
    return hn::Or(hn::Or(hn::Ne(cell[0], last[0]), hn::Ne(cell[1], last[1])),
                  hn::Ne(cell[2], last[2]));
  }

  // Time of crossing the next face of an axis.
  HWY_INLINE V TimeOf(int a) const {
    const V time = hn::Mul(hn::Sub(hn::Add(cell[a], up[a]), start[a]), inverse[a]);
    return hn::IfThenElse(hn::Ne(cell[a], last[a]), time,
                          Set(std::numeric_limits<double>::infinity()));
  }

  HWY_INLINE void Go(M moved) {
    const V x = TimeOf(0), y = TimeOf(1), z = TimeOf(2);
    const M y_before_x = hn::Lt(y, x);
    const M is_z = hn::Lt(z, hn::IfThenElse(y_before_x, y, x));
    const M moves[3] = {hn::Not(hn::Or(y_before_x, is_z)), hn::AndNot(is_z, y_before_x), is_z};
    for (int a = 0; a < 3; ++a)
      cell[a] = hn::Add(cell[a], hn::IfThenElseZero(hn::And(moved, moves[a]), step[a]));
  }
};

// Appends the voxels that may be in `wanted`.
HWY_INLINE void Meet(const V (&cell)[3], M asked, const VoxelHashes& wanted,
                     std::vector<VoxelKey>* met) {
  const Index di;
  const Hash dh;
  const auto x = hn::DemoteTo(di, cell[0]), y = hn::DemoteTo(di, cell[1]),
             z = hn::DemoteTo(di, cell[2]);
  const auto mixed = hn::Xor(hn::Xor(hn::Mul(hn::BitCast(dh, x), hn::Set(dh, VoxelHashes::kX)),
                                     hn::Mul(hn::BitCast(dh, y), hn::Set(dh, VoxelHashes::kY))),
                             hn::Mul(hn::BitCast(dh, z), hn::Set(dh, VoxelHashes::kZ)));
  const auto hash =
      hn::And(hn::Xor(mixed, hn::ShiftRight<16>(mixed)), hn::Set(dh, VoxelHashes::kBits - 1));
  const auto word = hn::GatherIndex(dh, wanted.words(), hn::BitCast(di, hn::ShiftRight<5>(hash)));
  const auto bit = hn::Shl(hn::Set(dh, 1), hn::And(hash, hn::Set(dh, 31)));
  std::array<std::uint8_t, 8> maybe{};
  hn::StoreMaskBits(dh, hn::Ne(hn::And(word, bit), hn::Zero(dh)), maybe.data());
  unsigned left = maybe[0] & BitsOf(asked);
  if (left == 0) return;
  alignas(64) std::int32_t keys[3][8];
  hn::StoreU(x, di, keys[0]);
  hn::StoreU(y, di, keys[1]);
  hn::StoreU(z, di, keys[2]);
  for (; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    met->push_back({keys[0][lane], keys[1][lane], keys[2][lane]});
  }
}

void WalkSegmentsLanes(const Segments& segments, const VoxelHashes& wanted,
                       std::vector<VoxelKey>* met) {
  const D d;
  for (int i = 0; i < segments.count; i += static_cast<int>(hn::Lanes(d))) {
    Walkers walkers(segments, i);
    const M used =
        hn::And(walkers.IsInReach(), hn::FirstN(d, static_cast<std::size_t>(segments.count - i)));
    for (;;) {
      const M is_walking = hn::And(used, walkers.IsWalking());
      if (hn::AllFalse(d, is_walking)) break;
      Meet(walkers.cell, is_walking, wanted, met);
      walkers.Go(is_walking);
    }
  }
}

}  // namespace crossnav::geometry::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::geometry {

HWY_EXPORT(FindSegmentsLanes);
HWY_EXPORT(WalkSegmentsLanes);

void FindSegments(const DepthFrame& frame, const MapConfig& config, const Gaps& gaps,
                  Segments* segments) {
  HWY_DYNAMIC_DISPATCH(FindSegmentsLanes)(frame, config, gaps, segments);
}

void WalkSegments(const Segments& segments, const VoxelHashes& wanted, std::vector<VoxelKey>* met) {
  HWY_DYNAMIC_DISPATCH(WalkSegmentsLanes)(segments, wanted, met);
}

}  // namespace crossnav::geometry
#endif  // HWY_ONCE
