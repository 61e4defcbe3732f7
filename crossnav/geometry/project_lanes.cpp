// SPDX-License-Identifier: MIT
#include "crossnav/geometry/project_lanes.h"

// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/geometry/project_lanes.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                   // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crossnav::geometry::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No fused multiply-add: its rounding differs between instruction
// sets.
using Wide = hn::CappedTag<float, 16>;
using Index = hn::RebindToSigned<Wide>;
using V = hn::Vec<Wide>;
using M = hn::Mask<Wide>;

constexpr int kTileShift = 2;    // DepthView's
constexpr int kLargest_px = 48;  // chosen: larger pictures are better asked part by part

HWY_INLINE std::uint64_t BitsOf(M mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(Wide(), mask, bytes.data());
  return bytes[0] | std::uint64_t{bytes[1]} << 8;
}

HWY_INLINE hn::Vec<Index> Clamp(hn::Vec<Index> v, int last) {
  const Index di;
  return hn::Max(hn::Zero(di), hn::Min(v, hn::Set(di, last)));
}

struct Picture {
  V z, u, v;
};

// Pixels with rays that may meet each voxel, and the voxel's nearest depth.
struct Pictures {
  alignas(64) std::array<std::int32_t, 64> u0, v0, u1, v1;
  alignas(64) std::array<float, 64> z_near_m;
};

// The ray nearest to the centre passes through the inner ball and ends beyond the voxel.
HWY_INLINE M PassedAtCenter(const LaneFrame& f, const Picture& p) {
  const Wide d;
  const Index di;
  const auto ui = hn::NearestInt(p.u), vi = hn::NearestInt(p.v);
  const auto uc = Clamp(ui, f.width - 1), vc = Clamp(vi, f.height - 1);
  const M inside = hn::RebindMask(d, hn::And(hn::Eq(ui, uc), hn::Eq(vi, vc)));
  const V reach = hn::GatherIndex(d, f.reach_m, hn::Add(hn::Mul(vc, hn::Set(di, f.width)), uc));
  const V du = hn::Mul(hn::Sub(p.u, hn::ConvertTo(d, ui)), hn::Mul(p.z, hn::Set(d, 1 / f.fx)));
  const V dv = hn::Mul(hn::Sub(p.v, hn::ConvertTo(d, vi)), hn::Mul(p.z, hn::Set(d, 1 / f.fy)));
  const V miss = hn::Add(hn::Mul(du, du), hn::Mul(dv, dv));
  const M beyond = hn::Gt(reach, hn::Add(p.z, hn::Set(d, f.half_z + f.margin_m)));
  return hn::And(hn::And(inside, beyond), hn::Lt(miss, hn::Set(d, f.ball_m2)));
}

// Half the size of a voxel's picture along one image axis, with room for rounding.
HWY_INLINE V PictureRadius(const LaneFrame& f, V offset_px, float focal, float half, V inverse) {
  const Wide d;
  const V slope = hn::Abs(hn::Mul(offset_px, hn::Set(d, 1 / focal)));
  const V reach =
      hn::Add(hn::Set(d, half + f.margin_m), hn::Mul(slope, hn::Set(d, f.half_z + f.margin_m)));
  const V px = hn::Mul(hn::Mul(hn::Set(d, focal), inverse), reach);
  return hn::Add(px, hn::Set(d, 0.05F));  // chosen: above rounding of a pixel coordinate
}

HWY_INLINE void StoreRange(V middle, V radius, int count, std::int32_t* first, std::int32_t* last) {
  const Wide d;
  const Index di;
  const V lo = hn::Max(hn::Sub(middle, radius), hn::Set(d, -1.0F));
  const V hi = hn::Min(hn::Add(middle, radius), hn::Set(d, static_cast<float>(count - 1)));
  hn::StoreU(hn::ConvertTo(di, hn::Ceil(hn::Max(lo, hn::Zero(d)))), di, first);
  hn::StoreU(hn::ConvertTo(di, hn::Floor(hi)), di, last);
}

// Some ray in the voxel's picture reaches it. `i`: place of the first lane in `out`.
HWY_INLINE M MayReach(const LaneFrame& f, const LaneCube& cube, const Picture& p, int i,
                      Pictures* out) {
  const Wide d;
  const Index di;
  const V z_near = hn::Sub(p.z, hn::Set(d, f.half_z + f.margin_m));
  const V inverse = hn::Div(hn::Set(d, 1.0F), z_near);
  const V ru = PictureRadius(f, hn::Sub(p.u, hn::Set(d, f.cx)), f.fx, f.half_x, inverse);
  const V rv = PictureRadius(f, hn::Sub(p.v, hn::Set(d, f.cy)), f.fy, f.half_y, inverse);
  const V right = hn::Set(d, static_cast<float>(f.width - 1));
  const V bottom = hn::Set(d, static_cast<float>(f.height - 1));
  const M in_view =
      hn::And(hn::And(hn::Ge(hn::Add(p.u, ru), hn::Zero(d)), hn::Le(hn::Sub(p.u, ru), right)),
              hn::And(hn::Ge(hn::Add(p.v, rv), hn::Zero(d)), hn::Le(hn::Sub(p.v, rv), bottom)));
  const auto tu = hn::ShiftRight<kTileShift>(Clamp(hn::ConvertTo(di, p.u), f.width - 1));
  const auto tv = hn::ShiftRight<kTileShift>(Clamp(hn::ConvertTo(di, p.v), f.height - 1));
  const V reach =
      hn::GatherIndex(d, cube.dilated_m, hn::Add(hn::Mul(tv, hn::Set(di, cube.columns)), tu));
  const V z_least = hn::Add(z_near, hn::Set(d, f.skip_m));
  const M may = hn::And(in_view, hn::Gt(reach, z_least));
  if (!hn::AllFalse(d, may)) {
    StoreRange(p.u, ru, f.width, out->u0.data() + i, out->u1.data() + i);
    StoreRange(p.v, rv, f.height, out->v0.data() + i, out->v1.data() + i);
    hn::StoreU(z_least, d, out->z_near_m.data() + i);
  }
  return may;
}

// Offsets along x and y of a slice of 4 x 4 voxels.
alignas(64) constexpr std::array<float, 16> kSliceX = {0, 1, 2, 3, 0, 1, 2, 3,
                                                       0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr std::array<float, 16> kSliceY = {0, 0, 0, 0, 1, 1, 1, 1,
                                                       2, 2, 2, 2, 3, 3, 3, 3};

// Footprints of the voxels; returns the voxels passed at the centre, and the undecided ones.
HWY_INLINE LaneAnswer AskCenters(const LaneFrame& f, const LaneCube& cube, Pictures* out) {
  const Wide d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(Wide()));
  const V far_px = hn::Set(d, 1e6F);
  LaneAnswer answer;
  for (int z = 0; z < 4; ++z) {
    for (int i = 0; i < 16; i += kLanes) {
      // From the camera to the voxels' centres, in voxels.
      const V nx = hn::Add(hn::Add(hn::Set(d, cube.first[0]), hn::LoadU(d, kSliceX.data() + i)),
                           hn::Set(d, 0.5F - f.fraction[0]));
      const V ny = hn::Add(hn::Add(hn::Set(d, cube.first[1]), hn::LoadU(d, kSliceY.data() + i)),
                           hn::Set(d, 0.5F - f.fraction[1]));
      const V nz = hn::Set(d, cube.first[2] + static_cast<float>(z) + (0.5F - f.fraction[2]));
      const auto in_camera = [&](int axis) {
        const float* row = f.to_camera.data() + 3 * axis;
        return hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), nx), hn::Mul(hn::Set(d, row[1]), ny)),
                       hn::Mul(hn::Set(d, row[2]), nz));
      };
      Picture p;
      p.z = in_camera(2);
      const V inverse = hn::Div(hn::Set(d, 1.0F), p.z);
      const auto pixel = [&](V at, float focal, float center) {
        const V px = hn::Add(hn::Mul(hn::Mul(hn::Set(d, focal), at), inverse), hn::Set(d, center));
        return hn::Max(hn::Neg(far_px), hn::Min(px, far_px));
      };
      p.u = pixel(in_camera(0), f.fx, f.cx);
      p.v = pixel(in_camera(1), f.fy, f.cy);
      const int place = 16 * z + i;
      const M passed = PassedAtCenter(f, p);
      const M possible = hn::AndNot(passed, MayReach(f, cube, p, place, out));
      answer.passed |= BitsOf(passed) << place;
      answer.possible |= BitsOf(possible) << place;
    }
  }
  return answer;
}

// Rays seen from the voxel: all go up along every axis, faces turned to match.
struct Turned {
  std::array<V, 3> ray, lo, hi;
};

HWY_INLINE Turned Turn(const LaneFrame& f, const LaneRows& rows, V pixel, float v) {
  const Wide d;
  Turned t;
  for (int a = 0; a < 3; ++a) {
    const V along =
        hn::Add(hn::Mul(hn::Set(d, f.per_u[a]), pixel), hn::Set(d, f.ray[a] + f.per_v[a] * v));
    const M is_down = hn::Lt(along, hn::Zero(d));
    const V lower = hn::Set(d, rows.lo[a]), upper = hn::Set(d, rows.lo[a] + 1);
    t.ray[a] = hn::Abs(along);
    t.lo[a] = hn::IfThenElse(is_down, hn::Neg(upper), lower);
    t.hi[a] = hn::IfThenElse(is_down, hn::Neg(lower), upper);
  }
  return t;
}

// How far the voxel is ahead of the camera and the ray's end behind the voxel, the lesser [voxels].
HWY_INLINE V Clearance(const Turned& t, V reach) {
  const auto beyond = [&](int a) { return hn::Sub(hn::Mul(reach, t.ray[a]), t.hi[a]); };
  return hn::Min(hn::Max(hn::Max(beyond(0), beyond(1)), beyond(2)),
                 hn::Min(hn::Min(t.hi[0], t.hi[1]), t.hi[2]));
}

// Slab test: the ray enters each pair of faces before it leaves any other. Crossing times are
// compared without divisions: lo_a / ray_a < hi_b / ray_b.
HWY_INLINE V Room(const Turned& t) {
  const auto room = [&](int in, int out) {
    return hn::Sub(hn::Mul(t.hi[out], t.ray[in]), hn::Mul(t.lo[in], t.ray[out]));
  };
  return hn::Min(hn::Min(hn::Min(room(0, 1), room(1, 0)), hn::Min(room(0, 2), room(2, 0))),
                 hn::Min(room(1, 2), room(2, 1)));
}

RowsAnswer AskRows(const LaneFrame& f, const LaneRows& rows) {
  const Wide d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V room = hn::Set(d, f.room_slack), beyond = hn::Set(d, f.beyond_slack);
  const V z_near = hn::Set(d, rows.z_near_m), last = hn::Set(d, static_cast<float>(rows.u1));
  bool is_possible = false;
  // From the middle outwards: a ray there is the likeliest to pass.
  const int count = (rows.v1 - rows.v0) / rows.step + 1, middle = count / 2;
  for (int i = 0; i < count; ++i) {
    const int place = middle + ((i & 1) != 0 ? -(i + 1) / 2 : i / 2);
    const int v = rows.v0 + place * rows.step;
    for (int u = rows.u0; u <= rows.u1; u += lanes) {
      const V pixel = hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(u)));
      const V reach = hn::LoadU(d, f.reach_m + static_cast<std::ptrdiff_t>(v) * f.width + u);
      const M reaches = hn::And(hn::Le(pixel, last), hn::Gt(reach, z_near));
      if (hn::AllFalse(d, reaches)) continue;
      const Turned t = Turn(f, rows, pixel, static_cast<float>(v));
      const V clear = Clearance(t, reach);
      const M clears = hn::And(reaches, hn::Gt(clear, hn::Neg(beyond)));
      if (hn::AllFalse(d, clears)) continue;
      const V met = Room(t);
      const M sure = hn::And(hn::Gt(met, room), hn::Gt(clear, beyond));
      if (!hn::AllFalse(d, hn::And(reaches, sure))) return RowsAnswer::kCertain;
      is_possible |= !hn::AllFalse(d, hn::And(clears, hn::Gt(met, hn::Neg(room))));
    }
  }
  return is_possible ? RowsAnswer::kPossible : RowsAnswer::kNone;
}

LaneAnswer AskCube(const LaneFrame& f, const LaneCube& cube) {
  Pictures pictures;
  LaneAnswer answer = AskCenters(f, cube, &pictures);
  answer.passed &= cube.asked;
  std::uint64_t left = answer.possible & cube.asked;
  answer.possible = 0;
  for (; left != 0; left &= left - 1) {
    const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
    const int width = pictures.u1[i] - pictures.u0[i] + 1;
    const int height = pictures.v1[i] - pictures.v0[i] + 1;
    if (cube.rows == 0 && HWY_MAX(width, height) > kLargest_px) {
      answer.possible |= std::uint64_t{1} << i;
      continue;
    }
    const int step = cube.rows == 0 ? 1 : HWY_MAX(1, height / cube.rows);
    const LaneRows rows{pictures.u0[i],
                        pictures.u1[i],
                        pictures.v0[i] + step / 2,
                        pictures.v1[i],
                        step,
                        pictures.z_near_m[i],
                        {cube.first[0] + static_cast<float>(i & 3) - f.fraction[0],
                         cube.first[1] + static_cast<float>((i >> 2) & 3) - f.fraction[1],
                         cube.first[2] + static_cast<float>(i >> 4) - f.fraction[2]}};
    const RowsAnswer found = AskRows(f, rows);
    if (found == RowsAnswer::kCertain) answer.passed |= std::uint64_t{1} << i;
    if (found == RowsAnswer::kPossible) answer.possible |= std::uint64_t{1} << i;
  }
  return answer;
}

}  // namespace crossnav::geometry::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::geometry {

HWY_EXPORT(AskCube);
HWY_EXPORT(AskRows);

LaneAnswer AskLaneCube(const LaneFrame& frame, const LaneCube& cube) {
  return HWY_DYNAMIC_DISPATCH(AskCube)(frame, cube);
}

RowsAnswer AskLaneRows(const LaneFrame& frame, const LaneRows& rows) {
  return HWY_DYNAMIC_DISPATCH(AskRows)(frame, rows);
}

}  // namespace crossnav::geometry
#endif  // HWY_ONCE
