// SPDX-License-Identifier: MIT
#include "crossnav/geometry/end_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/geometry/end_rows.cpp"  // NOLINT
#include <hwy/foreach_target.h>                              // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crossnav::geometry::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Narrow = hn::CappedTag<float, 16>;
using NarrowIndex = hn::RebindToSigned<Narrow>;
using Wide = hn::CappedTag<double, 8>;
using Reach = hn::Rebind<float, Wide>;
using Index = hn::Rebind<std::int32_t, Wide>;

// A row for float lanes, relative to the camera's voxel. The margin is the distance to a face
// beyond which rounding cannot change the voxel.
struct NarrowRays {
  std::array<float, 3> fraction{}, base{}, step{};  // of RowRays; fraction is start's in its voxel
  std::array<std::int32_t, 3> origin{};             // start's voxel
  float least_m = 0, most_m = 0, reach_most_m = 0;
  float doubt_vox = 0;
};

// The least float from `x` on, and the greatest up to it.
inline float FloatFrom(double x) {
  const auto f = static_cast<float>(x);
  return f < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}
inline float FloatUpTo(double x) {
  const auto f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

inline NarrowRays NarrowOf(const RowRays& rays, int width) {
  NarrowRays narrow;
  double greatest = 0;  // of a ray's summands [voxels per metre]
  for (std::size_t a = 0; a < 3; ++a) {
    const double origin = std::floor(rays.start[a]);
    narrow.origin[a] = static_cast<std::int32_t>(origin);
    narrow.fraction[a] = static_cast<float>(rays.start[a] - origin);
    narrow.base[a] = static_cast<float>(rays.base[a]);
    narrow.step[a] = static_cast<float>(rays.step[a]);
    greatest = std::max(greatest, std::abs(rays.base[a]) + std::abs(rays.step[a]) * width);
  }
  narrow.least_m = std::max(FloatFrom(rays.depth_min_m), std::numeric_limits<float>::denorm_min());
  narrow.most_m = FloatUpTo(rays.depth_max_m);
  narrow.reach_most_m = static_cast<float>(rays.depth_max_m);
  // Four roundings of the ray, two of the point, and the rounding of `fraction`.
  narrow.doubt_vox = static_cast<float>(std::numeric_limits<float>::epsilon() *
                                        (4 * greatest * rays.depth_max_m + 2));
  return narrow;
}

template <class D>
struct Lanes {
  hn::Vec<D> reach;
  hn::Vec<D> off_middle;  // greatest distance from the middle of a voxel, over the axes
};

// Voxel coordinate along one axis.
template <class D, class T>
HWY_INLINE hn::Vec<D> FloorOf(D d, T start, T base, T step, hn::Vec<D> u, Lanes<D>* lanes) {
  const auto ray = hn::MulAdd(hn::Set(d, step), u, hn::Set(d, base));
  const auto q = hn::MulAdd(lanes->reach, ray, hn::Set(d, start));
  const auto floor = hn::Floor(q);
  const auto off = hn::Abs(hn::Sub(hn::Sub(q, floor), hn::Set(d, static_cast<T>(0.5))));
  lanes->off_middle = hn::Max(lanes->off_middle, off);
  return floor;
}

HWY_INLINE void ComputeWide(const float* depth_m, int u, const RowRays& rays, RowEnds* ends) {
  // chosen: rounding of the row's formula stays below 1e-10 voxels for maps of many kilometres.
  constexpr double kDoubt_vox = 1e-9;
  const Wide d;
  const Reach df;
  const Index di;
  const auto depth = hn::PromoteTo(d, hn::LoadU(df, depth_m + u));
  const auto ends_here =
      hn::And(hn::And(hn::Ge(depth, hn::Set(d, rays.depth_min_m)), hn::Gt(depth, hn::Zero(d))),
              hn::Le(depth, hn::Set(d, rays.depth_max_m)));
  Lanes<Wide> lanes{hn::IfThenElseZero(ends_here, depth), hn::Zero(d)};
  const auto pixel = hn::Add(hn::Iota(d, 0.0), hn::Set(d, static_cast<double>(u)));
  const auto along = [&](std::size_t a) {
    return FloorOf(d, rays.start[a], rays.base[a], rays.step[a], pixel, &lanes);
  };
  const auto x = along(0), y = along(1), z = along(2);
  const auto none = hn::Set(d, static_cast<double>(kNoEnd));
  hn::StoreU(hn::DemoteTo(di, hn::IfThenElse(ends_here, x, none)), di, ends->x.data() + u);
  hn::StoreU(hn::DemoteTo(di, y), di, ends->y.data() + u);
  hn::StoreU(hn::DemoteTo(di, z), di, ends->z.data() + u);
  const auto special = hn::And(hn::Gt(lanes.off_middle, hn::Set(d, 0.5 - kDoubt_vox)), ends_here);
  if (HWY_LIKELY(hn::AllFalse(d, special))) return;
  alignas(64) std::array<double, 8> flags;
  hn::Store(hn::IfThenElseZero(special, hn::Set(d, 1.0)), d, flags.data());
  for (std::size_t i = 0; i < hn::Lanes(d); ++i)
    if (flags[i] != 0) ends->special[ends->special_count++] = u + static_cast<int>(i);
}

// False where some pixel's voxel is in doubt.
HWY_INLINE bool ComputeNarrow(const float* depth_m, int u, const NarrowRays& rays, RowEnds* ends,
                              float* reach_m) {
  const Narrow d;
  const NarrowIndex di;
  const auto depth = hn::LoadU(d, depth_m + u);
  const auto says = hn::And(hn::Ge(depth, hn::Set(d, rays.least_m)),
                            hn::Le(depth, hn::Set(d, std::numeric_limits<float>::max())));
  const auto ends_here = hn::And(says, hn::Le(depth, hn::Set(d, rays.most_m)));
  const auto is_beyond = hn::AndNot(ends_here, says);
  Lanes<Narrow> lanes{hn::IfThenElseZero(says, hn::Min(depth, hn::Set(d, rays.reach_most_m))),
                      hn::Zero(d)};
  hn::StoreU(lanes.reach, d, reach_m + u);
  const auto pixel = hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(u)));
  const auto along = [&](std::size_t a) {
    const auto floor = FloorOf(d, rays.fraction[a], rays.base[a], rays.step[a], pixel, &lanes);
    return hn::Add(hn::ConvertTo(di, floor), hn::Set(di, rays.origin[a]));
  };
  const auto x = along(0), y = along(1), z = along(2);
  const auto none = hn::Set(di, kNoEnd);
  hn::StoreU(hn::IfThenElse(hn::RebindMask(di, ends_here), x, none), di, ends->x.data() + u);
  hn::StoreU(y, di, ends->y.data() + u);
  hn::StoreU(z, di, ends->z.data() + u);
  if (!hn::AllFalse(d, is_beyond)) {
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(d, is_beyond, bytes.data());
    const unsigned bits = bytes[0] | bytes[1] << 8;
    if (ends->last_beyond < 0) ends->first_beyond = u + std::countr_zero(bits);
    ends->last_beyond = u + std::bit_width(bits) - 1;
  }
  const auto doubted = hn::Gt(lanes.off_middle, hn::Set(d, 0.5F - rays.doubt_vox));
  return hn::AllFalse(d, hn::And(doubted, ends_here));
}

HWY_INLINE void ComputeLanes(const float* depth_m, int u, const RowRays& rays,
                             const NarrowRays& narrow, RowEnds* ends, float* reach_m) {
  if (HWY_LIKELY(ComputeNarrow(depth_m, u, narrow, ends, reach_m))) return;
  const auto all = static_cast<int>(hn::Lanes(Narrow())),
             part = static_cast<int>(hn::Lanes(Wide()));
  for (int i = 0; i < all; i += part) ComputeWide(depth_m, u + i, rays, ends);
}

void ComputeRowLanes(const float* depth_m, RowSpan pixels, const RowRays& rays, RowEnds* ends,
                     float* reach_m) {
  const int lanes = static_cast<int>(hn::Lanes(Narrow())), width = pixels.end;
  NarrowRays narrow = NarrowOf(rays, width);
  ends->special_count = 0;
  ends->first_beyond = 0;
  ends->last_beyond = -1;
  int u = pixels.first;
  for (; u + lanes <= width; u += lanes) ComputeLanes(depth_m, u, rays, narrow, ends, reach_m);
  if (u >= width) return;
  // The rest through a padded copy.
  std::array<float, kRowEndsPad> depth_rest{}, reach_rest{};
  RowEnds& rest = *ends->rest;
  rest.special_count = 0;
  rest.last_beyond = -1;
  std::copy(depth_m + u, depth_m + width, depth_rest.begin());
  RowRays shifted = rays;
  for (std::size_t a = 0; a < 3; ++a) {
    shifted.base[a] += rays.step[a] * u;
    narrow.base[a] = static_cast<float>(shifted.base[a]);
  }
  ComputeLanes(depth_rest.data(), 0, shifted, narrow, &rest, reach_rest.data());
  for (int i = 0; u + i < width; ++i) {
    ends->x[u + i] = rest.x[i];
    ends->y[u + i] = rest.y[i];
    ends->z[u + i] = rest.z[i];
    reach_m[u + i] = reach_rest[i];
  }
  for (int i = 0; i < rest.special_count; ++i)
    ends->special[ends->special_count++] = u + rest.special[i];
  if (rest.last_beyond < 0) return;
  if (ends->last_beyond < 0) ends->first_beyond = u + rest.first_beyond;
  ends->last_beyond = u + rest.last_beyond;
}

// Voxels of a row, from some pixel on.
struct RowPart {
  const std::int32_t *x, *y, *z;
};

using Keys = hn::CappedTag<std::int32_t, 16>;

// Appends `first` + i for every chosen lane i. A whole vector is stored and its tail overwritten by
// the next call: masked stores are slow on some processors, and a count-dependent branch is
// unpredictable.
HWY_INLINE void Append(hn::Mask<Keys> chosen, int first, std::int32_t* out, int* found) {
  const Keys d;
  const auto places = hn::Add(hn::Iota(d, 0), hn::Set(d, first));
  hn::StoreU(hn::Compress(places, chosen), d, out + *found);
  *found += static_cast<int>(hn::CountTrue(d, chosen));
}

// Where two voxels differ.
HWY_INLINE hn::Mask<Keys> Differ(RowPart a, RowPart b, int i) {
  const Keys d;
  const auto differ = [&](const std::int32_t* p, const std::int32_t* q) {
    return hn::Ne(hn::LoadU(d, p + i), hn::LoadU(d, q + i));
  };
  return hn::Or(hn::Or(differ(a.x, b.x), differ(a.y, b.y)), differ(a.z, b.z));
}

// Whether two voxels share no face, or one of them is missing; undefined if both are missing.
HWY_INLINE hn::Mask<Keys> Apart(RowPart a, RowPart b, int i) {
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

void FindRunsLanes(int width, RowEnds* ends) {
  const Keys d;
  const int lanes = static_cast<int>(hn::Lanes(d)), count = width - 1;
  const RowPart row{ends->x.data(), ends->y.data(), ends->z.data()};
  ends->starts[0] = 0;
  ends->start_count = 1;
  for (int i = 0; i < count; i += lanes) {
    const auto in_row = hn::FirstN(d, static_cast<std::size_t>(count - i));
    const auto starts = hn::And(Differ({row.x + 1, row.y + 1, row.z + 1}, row, i), in_row);
    Append(starts, i + 1, ends->starts.data(), &ends->start_count);
  }
}

// The next pixels of a word: from the first bit that is left on, which Next takes away.
struct WordPart {
  int skipped = 0;  // pixels of the word before it
  hn::Mask<Keys> asked;
};

HWY_INLINE WordPart Next(std::uint64_t* left) {
  const Keys d;
  const int skipped = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(*left));
  const std::uint64_t asked = *left >> skipped;
  const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(asked),
                                          static_cast<std::uint8_t>(asked >> 8)};
  const int done = skipped + static_cast<int>(hn::Lanes(d));
  *left = done < 64 ? *left >> done << done : 0;
  return {skipped, hn::LoadMaskBits(d, bytes.data())};
}

int FindApartLanes(const PixelWord& pixels, const RowEnds& row, const RowEnds& next, int shift,
                   std::int32_t* out) {
  const auto from = [](const RowEnds& ends, int u) {
    return RowPart{ends.x.data() + u, ends.y.data() + u, ends.z.data() + u};
  };
  int found = 0;
  for (std::uint64_t left = pixels.bits; left != 0;) {
    const WordPart part = Next(&left);
    const int u = pixels.first + part.skipped;
    const auto apart = Apart(from(row, u), from(next, u + shift), 0);
    Append(hn::And(part.asked, apart), u, out, &found);
  }
  return found;
}

std::uint64_t FindNearLanes(const PixelWord& pixels, const float* reach_m, const float* below_m,
                            float farthest_m) {
  const hn::RebindToFloat<Keys> d;
  std::uint64_t near = 0;
  for (std::uint64_t left = pixels.bits; left != 0;) {
    const WordPart part = Next(&left);
    const int u = pixels.first + part.skipped;
    const auto least = hn::Min(hn::Min(hn::LoadU(d, reach_m + u), hn::LoadU(d, reach_m + u + 1)),
                               hn::LoadU(d, below_m + u));
    const auto is_near = hn::RebindMask(Keys(), hn::Le(least, hn::Set(d, farthest_m)));
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(Keys(), hn::And(part.asked, is_near), bytes.data());
    near |= (bytes[0] | std::uint64_t{bytes[1]} << 8) << part.skipped;
  }
  return near;
}

}  // namespace crossnav::geometry::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::geometry {

HWY_EXPORT(ComputeRowLanes);
HWY_EXPORT(FindRunsLanes);
HWY_EXPORT(FindApartLanes);
HWY_EXPORT(FindNearLanes);

void RowEnds::Resize(int width) {
  for (auto* list : {&x, &y, &z, &special, &starts}) list->resize(width + kRowEndsPad);
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

int FindApart(const PixelWord& pixels, const RowEnds& row, const RowEnds& next, int shift,
              std::int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(FindApartLanes)(pixels, row, next, shift, out);
}

std::uint64_t FindNear(const PixelWord& pixels, const float* reach_m, const float* below_m,
                       float farthest_m) {
  return HWY_DYNAMIC_DISPATCH(FindNearLanes)(pixels, reach_m, below_m, farthest_m);
}

}  // namespace crossnav::geometry
#endif  // HWY_ONCE
