// SPDX-License-Identifier: MIT
#include "crossnav/geometry/end_rows.h"

#include <algorithm>
#include <cstdlib>

// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/geometry/end_rows.cpp"  // NOLINT
#include <hwy/foreach_target.h>                              // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crossnav::geometry::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::ScalableTag<double>;
using Reach = hn::Rebind<float, Wide>;
using Index = hn::Rebind<std::int32_t, Wide>;

// chosen: rounding of the row's formula stays below 1e-10 voxels for maps of many kilometres.
constexpr double kDoubt_vox = 1e-9;

struct Lanes {
  hn::Vec<Wide> reach;
  hn::Vec<Wide> off_middle;  // greatest distance from the middle of a voxel, over the axes
};

// Voxel coordinate along one axis.
HWY_INLINE hn::Vec<Wide> FloorOf(const RowRays& rays, int axis, hn::Vec<Wide> u, Lanes* lanes) {
  const Wide d;
  const auto ray = hn::MulAdd(hn::Set(d, rays.step[axis]), u, hn::Set(d, rays.base[axis]));
  const auto q = hn::MulAdd(lanes->reach, ray, hn::Set(d, rays.start[axis]));
  const auto floor = hn::Floor(q);
  const auto off = hn::Abs(hn::Sub(hn::Sub(q, floor), hn::Set(d, 0.5)));
  lanes->off_middle = hn::Max(lanes->off_middle, off);
  return floor;
}

HWY_INLINE void ComputeLanes(const float* depth_m, int u, const RowRays& rays, RowEnds* ends,
                             float* reach_m) {
  const Wide d;
  const Reach df;
  const Index di;
  const auto depth = hn::PromoteTo(d, hn::LoadU(df, depth_m + u));
  const auto least = hn::Set(d, rays.depth_min_m);
  const auto most = hn::Set(d, static_cast<double>(static_cast<float>(rays.depth_max_m)));
  const auto greatest = hn::Set(d, static_cast<double>(std::numeric_limits<float>::max()));
  const auto says =
      hn::And(hn::And(hn::Ge(depth, least), hn::Gt(depth, hn::Zero(d))), hn::Le(depth, greatest));
  Lanes lanes{hn::IfThenElseZero(says, hn::Min(depth, most)), hn::Zero(d)};
  hn::StoreU(hn::DemoteTo(df, lanes.reach), df, reach_m + u);
  const auto pixel = hn::Add(hn::Iota(d, 0.0), hn::Set(d, static_cast<double>(u)));
  const auto x = FloorOf(rays, 0, pixel, &lanes);
  const auto y = FloorOf(rays, 1, pixel, &lanes);
  const auto z = FloorOf(rays, 2, pixel, &lanes);
  const auto none = hn::Set(d, static_cast<double>(kNoEnd));
  hn::StoreU(hn::DemoteTo(di, hn::IfThenElse(says, x, none)), di, ends->x.data() + u);
  hn::StoreU(hn::DemoteTo(di, y), di, ends->y.data() + u);
  hn::StoreU(hn::DemoteTo(di, z), di, ends->z.data() + u);
  const auto is_near = hn::Gt(lanes.off_middle, hn::Set(d, 0.5 - kDoubt_vox));
  const auto is_beyond = hn::Gt(depth, hn::Set(d, rays.depth_max_m));
  const auto special = hn::And(hn::Or(is_near, is_beyond), says);
  if (HWY_LIKELY(hn::AllFalse(d, special))) return;
  alignas(64) std::array<double, 64> flags;  // chosen: more lanes than any instruction set has
  hn::Store(hn::IfThenElseZero(special, hn::Set(d, 1.0)), d, flags.data());
  for (std::size_t i = 0; i < hn::Lanes(d); ++i)
    if (flags[i] != 0) ends->special[ends->special_count++] = u + static_cast<int>(i);
}

void ComputeRowLanes(const float* depth_m, RowSpan pixels, const RowRays& rays, RowEnds* ends,
                     float* reach_m) {
  const int lanes = static_cast<int>(hn::Lanes(Wide())), width = pixels.end;
  ends->special_count = 0;
  int u = pixels.first;
  for (; u + lanes <= width; u += lanes) ComputeLanes(depth_m, u, rays, ends, reach_m);
  if (u >= width) return;
  // The rest through a padded copy.
  std::array<float, 64> depth_rest{}, reach_rest{};
  RowEnds& rest = *ends->rest;
  rest.special_count = 0;
  std::copy(depth_m + u, depth_m + width, depth_rest.begin());
  RowRays shifted = rays;
  for (int a = 0; a < 3; ++a) shifted.base[a] += rays.step[a] * u;
  ComputeLanes(depth_rest.data(), 0, shifted, &rest, reach_rest.data());
  for (int i = 0; u + i < width; ++i) {
    ends->x[u + i] = rest.x[i];
    ends->y[u + i] = rest.y[i];
    ends->z[u + i] = rest.z[i];
    reach_m[u + i] = reach_rest[i];
  }
  for (int i = 0; i < rest.special_count; ++i)
    if (u + rest.special[i] < width) ends->special[ends->special_count++] = u + rest.special[i];
}

// Voxels of a row, from some pixel on.
struct RowPart {
  const std::int32_t *x, *y, *z;
};

using Keys = hn::CappedTag<std::int32_t, 16>;

// Where two voxels differ.
struct Differ {
  static HWY_INLINE hn::Mask<Keys> Of(RowPart a, RowPart b, int i) {
    const Keys d;
    const auto differ = [&](const std::int32_t* p, const std::int32_t* q) {
      return hn::Ne(hn::LoadU(d, p + i), hn::LoadU(d, q + i));
    };
    return hn::Or(hn::Or(differ(a.x, b.x), differ(a.y, b.y)), differ(a.z, b.z));
  }
  static bool At(RowPart a, RowPart b, int i) {
    return a.x[i] != b.x[i] || a.y[i] != b.y[i] || a.z[i] != b.z[i];
  }
};

// Where two voxels share no face, or only one is there; maybe where none is.
struct Apart {
  static HWY_INLINE hn::Mask<Keys> Of(RowPart a, RowPart b, int i) {
    const Keys d;
    const auto none = hn::Set(d, kNoEnd);
    const auto ax = hn::LoadU(d, a.x + i), bx = hn::LoadU(d, b.x + i);
    const auto off = [&](const std::int32_t* p, const std::int32_t* q) {
      return hn::Abs(hn::Sub(hn::LoadU(d, p + i), hn::LoadU(d, q + i)));
    };
    const auto sum = hn::Add(hn::Abs(hn::Sub(ax, bx)), hn::Add(off(a.y, b.y), off(a.z, b.z)));
    const auto is_one = hn::Xor(hn::Eq(ax, none), hn::Eq(bx, none));
    return hn::Or(is_one, hn::Gt(sum, hn::Set(d, 1)));
  }
  static bool At(RowPart a, RowPart b, int i) {
    if ((a.x[i] == kNoEnd) != (b.x[i] == kNoEnd)) return true;
    return std::abs(a.x[i] - b.x[i]) + std::abs(a.y[i] - b.y[i]) + std::abs(a.z[i] - b.z[i]) > 1;
  }
};

// Lists `first` + i for every i < count where the two are so.
template <class How>
int FindWhere(RowPart a, RowPart b, int count, int first, std::int32_t* out) {
  const Keys d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::array<std::uint8_t, 8> bytes{};
  int found = 0, i = 0;
  for (; i + lanes <= count; i += lanes) {
    // By scanning bits: storing compressed lanes is slow on some machines.
    hn::StoreMaskBits(d, How::Of(a, b, i), bytes.data());
    for (unsigned bits = bytes[0] | bytes[1] << 8; bits != 0; bits &= bits - 1)
      out[found++] = first + i + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
  }
  for (; i < count; ++i)
    if (How::At(a, b, i)) out[found++] = first + i;
  return found;
}

void FindRunsLanes(int width, RowEnds* ends) {
  const RowPart row{ends->x.data(), ends->y.data(), ends->z.data()};
  ends->starts[0] = 0;
  ends->start_count = 1 + FindWhere<Differ>({row.x + 1, row.y + 1, row.z + 1}, row, width - 1, 1,
                                            ends->starts.data() + 1);
}

int FindApartLanes(RowSpan pixels, const RowEnds& row, const RowEnds& next, int shift,
                   std::int32_t* out) {
  const auto from = [](const RowEnds& ends, int u) {
    return RowPart{ends.x.data() + u, ends.y.data() + u, ends.z.data() + u};
  };
  return FindWhere<Apart>(from(row, pixels.first), from(next, pixels.first + shift),
                          pixels.end - pixels.first, pixels.first, out);
}

}  // namespace crossnav::geometry::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::geometry {

HWY_EXPORT(ComputeRowLanes);
HWY_EXPORT(FindRunsLanes);
HWY_EXPORT(FindApartLanes);

namespace {
constexpr int kPad = 64;  // chosen: more lanes than any instruction set has
}  // namespace

void RowEnds::Resize(int width) {
  for (auto* list : {&x, &y, &z, &special, &starts}) list->resize(width + kPad);
  if (width > 0 && !rest) {
    rest = std::make_unique<RowEnds>();
    rest->Resize(0);
  }
}

void ComputeRow(const float* depth_m, RowSpan pixels, const RowRays& rays, RowEnds* ends,
                float* reach_m) {
  HWY_DYNAMIC_DISPATCH(ComputeRowLanes)(depth_m, pixels, rays, ends, reach_m);
}

void FindRuns(int width, RowEnds* ends) {
  HWY_DYNAMIC_DISPATCH(FindRunsLanes)(width, ends);
}

int FindApart(RowSpan pixels, const RowEnds& row, const RowEnds& next, int shift,
              std::int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(FindApartLanes)(pixels, row, next, shift, out);
}

}  // namespace crossnav::geometry
#endif  // HWY_ONCE
