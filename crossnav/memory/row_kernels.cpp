// SPDX-License-Identifier: MIT
#include "crossnav/memory/row_kernels.h"

#include <algorithm>
#include <cmath>

// Disables targets with vectors of unknown size: arrays of vectors need a known size.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
// This file is compiled once per instruction set by the include below.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crossnav/memory/row_kernels.cpp"  // NOLINT
#include <hwy/foreach_target.h>                               // IWYU pragma: keep

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crossnav::memory::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::CappedTag<float, 16>;
using Single = hn::CappedTag<float, 1>;
constexpr std::size_t kLanes = hn::MaxLanes(Wide());
constexpr std::size_t kVectors = kRowPad / kLanes;  // of one block of kRowPad elements
constexpr std::size_t kSums = 8;  // chosen: vectors of sums at a time, half of the fewest registers

template <class D>
HWY_INLINE hn::Vec<D> LoadElements(D d, const std::uint16_t* p) {
  const hn::Rebind<std::uint16_t, D> du;
  const hn::Rebind<hwy::float16_t, D> dh;
  return hn::PromoteTo(d, hn::BitCast(dh, hn::LoadU(du, p)));
}
template <class D>
HWY_INLINE hn::Vec<D> LoadElements(D d, const float* p) {
  return hn::LoadU(d, p);
}

// Stores elements and returns their values after rounding to the element type.
template <class D>
HWY_INLINE hn::Vec<D> StoreElements(D d, hn::Vec<D> v, std::uint16_t* p) {
  const hn::Rebind<std::uint16_t, D> du;
  const hn::Rebind<hwy::float16_t, D> dh;
  v = hn::Max(hn::Min(v, hn::Set(d, 65504.0f)), hn::Set(d, -65504.0f));
  const auto half = hn::DemoteTo(dh, v);
  hn::StoreU(hn::BitCast(du, half), du, p);
  return hn::PromoteTo(d, half);
}
template <class D>
HWY_INLINE hn::Vec<D> StoreElements(D d, hn::Vec<D> v, float* p) {
  hn::StoreU(v, d, p);
  return v;
}

// Tree sum of a vector: lane i adds lane i + half, then the halves recursively.
template <class D>
HWY_INLINE float SumTree(D d, hn::Vec<D> v) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return SumTree(half, hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  }
#endif
  alignas(64) float lanes[hn::MaxLanes(D())];
  hn::Store(v, d, lanes);
  for (std::size_t half = hn::MaxLanes(D()) / 2; half > 0; half /= 2)
    for (std::size_t i = 0; i < half; ++i) lanes[i] += lanes[i + half];
  return lanes[0];
}

// Sum of the 32 virtual lanes in five halvings: the same order on every instruction set.
HWY_INLINE float SumBlock(hn::Vec<Wide>* v) {
  for (std::size_t half = kVectors / 2; half > 0; half /= 2)
    for (std::size_t k = 0; k < half; ++k) v[k] = hn::Add(v[k], v[k + half]);
  return SumTree(Wide(), v[0]);
}

// Fuses `kBlocks` blocks of kRowPad elements from `i` on; each share is loaded once for all of
// them.
template <std::size_t kBlocks, class T>
HWY_INLINE void FuseBlocks(T* HWY_RESTRICT row, int i, int dim, float keep,
                           const float* HWY_RESTRICT grid, std::span<const CellShare> shares,
                           hn::Vec<Wide>* squares) {
  const Wide d;
  const auto vkeep = hn::Set(d, keep);
  hn::Vec<Wide> sum[kBlocks * kVectors];
  for (std::size_t k = 0; k < kBlocks * kVectors; ++k)
    sum[k] = hn::Mul(vkeep, LoadElements(d, row + i + k * kLanes));
  for (const CellShare& s : shares) {
    const float* cell = grid + static_cast<std::ptrdiff_t>(s.cell) * dim + i;
    const auto share = hn::Set(d, s.share);
    for (std::size_t k = 0; k < kBlocks * kVectors; ++k)
      sum[k] = hn::MulAdd(share, hn::LoadU(d, cell + k * kLanes), sum[k]);
  }
  for (std::size_t k = 0; k < kBlocks * kVectors; ++k) {
    const auto stored = StoreElements(d, sum[k], row + i + k * kLanes);
    squares[k % kVectors] = hn::MulAdd(stored, stored, squares[k % kVectors]);
  }
}

template <class T>
HWY_INLINE float FuseRowT(T* HWY_RESTRICT row, int dim, float keep, const float* HWY_RESTRICT grid,
                          std::span<const CellShare> shares) {
  constexpr std::size_t kBlocks = kVectors < kSums ? kSums / kVectors : 1;
  const Wide d;
  hn::Vec<Wide> squares[kVectors];
  for (auto& s : squares) s = hn::Zero(d);
  int i = 0;
  for (; i + static_cast<int>(kBlocks) * kRowPad <= dim; i += kBlocks * kRowPad)
    FuseBlocks<kBlocks>(row, i, dim, keep, grid, shares, squares);
  for (; i + kRowPad <= dim; i += kRowPad) FuseBlocks<1>(row, i, dim, keep, grid, shares, squares);
  float total = SumBlock(squares);
  const Single d1;
  for (; i < dim; ++i) {
    auto sum = hn::Mul(hn::Set(d1, keep), LoadElements(d1, row + i));
    for (const CellShare& s : shares)
      sum = hn::MulAdd(hn::Set(d1, s.share),
                       hn::LoadU(d1, grid + static_cast<std::ptrdiff_t>(s.cell) * dim + i), sum);
    const float stored = hn::GetLane(StoreElements(d1, sum, row + i));
    total += stored * stored;
  }
  return total;
}

constexpr std::uintptr_t kPrefetchBytes = 8192;  // chosen: measured, 6 % above plain reading

template <class T>
HWY_INLINE void PrefetchAhead(const T* p) {
  // As an integer, because the address may lie past the end of the rows.
  const auto at = reinterpret_cast<std::uintptr_t>(p) + kPrefetchBytes;
  hwy::Prefetch(reinterpret_cast<const T*>(at));  // NOLINT(performance-no-int-to-ptr)
}

template <class T>
HWY_INLINE void DotRowsT(const T* HWY_RESTRICT rows, int stride, std::size_t count,
                         const float* HWY_RESTRICT text, float* HWY_RESTRICT out) {
  const Wide d;
  for (std::size_t r = 0; r < count; ++r, rows += stride) {
    hn::Vec<Wide> sum[kVectors];
    for (auto& s : sum) s = hn::Zero(d);
    for (int i = 0; i < stride; i += kRowPad) {
      PrefetchAhead(rows + i);
      for (std::size_t k = 0; k < kVectors; ++k)
        sum[k] = hn::MulAdd(LoadElements(d, rows + i + k * kLanes),
                            hn::LoadU(d, text + i + k * kLanes), sum[k]);
    }
    out[r] = SumBlock(sum);
  }
}

float FuseHalf(std::uint16_t* row, int dim, float keep, const float* grid,
               std::span<const CellShare> shares) {
  return FuseRowT(row, dim, keep, grid, shares);
}
float FuseFloat(float* row, int dim, float keep, const float* grid,
                std::span<const CellShare> shares) {
  return FuseRowT(row, dim, keep, grid, shares);
}
void DotHalf(const std::uint16_t* rows, int stride, std::size_t count, const float* text,
             float* out) {
  DotRowsT(rows, stride, count, text, out);
}
void DotFloat(const float* rows, int stride, std::size_t count, const float* text, float* out) {
  DotRowsT(rows, stride, count, text, out);
}

// Products of adjacent elements add up in 32 bits; integer sums do not depend on the order.
void DotCompact(const std::int8_t* HWY_RESTRICT rows, int stride, std::size_t count,
                const std::int16_t* HWY_RESTRICT text, std::int32_t* HWY_RESTRICT out) {
  const hn::CappedTag<std::int16_t, kRowPad> d16;
  const hn::RepartitionToWide<decltype(d16)> d32;
  const hn::Rebind<std::int8_t, decltype(d16)> d8;
  const int lanes = static_cast<int>(hn::Lanes(d16));
  for (std::size_t r = 0; r < count; ++r, rows += stride) {
    auto sum0 = hn::Zero(d32), sum1 = hn::Zero(d32);
    for (int i = 0; i < stride; i += kRowPad) {
      PrefetchAhead(rows + i);
      for (int k = i; k < i + kRowPad; k += lanes)
        sum0 = hn::ReorderWidenMulAccumulate(d32, hn::PromoteTo(d16, hn::LoadU(d8, rows + k)),
                                             hn::LoadU(d16, text + k), sum0, sum1);
    }
    out[r] = hn::GetLane(hn::SumOfLanes(d32, hn::Add(sum0, sum1)));
  }
}

template <class D>
HWY_INLINE void QuantizeAt(D d, const float* in, float inverse, std::int8_t* out) {
  const hn::Rebind<std::int8_t, D> d8;
  const auto whole = hn::NearestInt(hn::Mul(hn::LoadU(d, in), hn::Set(d, inverse)));
  hn::StoreU(hn::DemoteTo(d8, whole), d8, out);
}

void ConvertToCompact(std::span<const float> in, float inverse, std::int8_t* out) {
  std::size_t i = 0;
  for (; i + kLanes <= in.size(); i += kLanes) QuantizeAt(Wide(), &in[i], inverse, out + i);
  for (; i < in.size(); ++i) QuantizeAt(Single(), &in[i], inverse, out + i);
}

template <class D>
HWY_INLINE void DequantizeAt(D d, const std::int8_t* in, float scale, float* out) {
  const hn::Rebind<std::int8_t, D> d8;
  const hn::Rebind<std::int32_t, D> d32;
  const auto whole = hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d8, in)));
  hn::StoreU(hn::Mul(whole, hn::Set(d, scale)), d, out);
}

void ConvertFromCompact(std::span<const std::int8_t> in, float scale, float* out) {
  std::size_t i = 0;
  for (; i + kLanes <= in.size(); i += kLanes) DequantizeAt(Wide(), &in[i], scale, out + i);
  for (; i < in.size(); ++i) DequantizeAt(Single(), &in[i], scale, out + i);
}

void ConvertToHalf(std::span<const float> in, std::uint16_t* out) {
  const Wide d;
  const Single d1;
  std::size_t i = 0;
  for (; i + kLanes <= in.size(); i += kLanes) StoreElements(d, hn::LoadU(d, &in[i]), out + i);
  for (; i < in.size(); ++i) StoreElements(d1, hn::LoadU(d1, &in[i]), out + i);
}
void ConvertFromHalf(std::span<const std::uint16_t> in, float* out) {
  const Wide d;
  const Single d1;
  std::size_t i = 0;
  for (; i + kLanes <= in.size(); i += kLanes) hn::StoreU(LoadElements(d, &in[i]), d, out + i);
  for (; i < in.size(); ++i) hn::StoreU(LoadElements(d1, &in[i]), d1, out + i);
}

// 0 * x is 0 for finite x and NaN otherwise.
bool CheckFinite(std::span<const float> values) {
  const Wide d;
  auto sum = hn::Zero(d);
  const auto zero = hn::Zero(d);
  std::size_t i = 0;
  for (; i + kLanes <= values.size(); i += kLanes)
    sum = hn::MulAdd(hn::LoadU(d, &values[i]), zero, sum);
  float rest = 0;
  for (; i < values.size(); ++i) rest += 0.0f * values[i];
  return rest == 0.0f && hn::AllTrue(d, hn::Eq(sum, zero));
}

template <class D>
HWY_INLINE void CopyValidAt(D d, const float* in, float* out) {
  const auto depth = hn::LoadU(d, in);
  const auto is_valid =
      hn::And(hn::Gt(depth, hn::Zero(d)), hn::Le(depth, hn::Set(d, hwy::HighestValue<float>())));
  hn::StoreU(hn::IfThenElseZero(is_valid, depth), d, out);
}

void CopyValid(const float* in, int width, float* out) {
  int u = 0;
  for (; u + static_cast<int>(kLanes) <= width; u += kLanes) CopyValidAt(Wide(), in + u, out + u);
  for (; u < width; ++u) CopyValidAt(Single(), in + u, out + u);
}

template <class D>
HWY_INLINE hn::Vec<D> Gradient(D d, hn::Vec<D> before, hn::Vec<D> center, hn::Vec<D> after) {
  const auto zero = hn::Zero(d);
  const auto has_before = hn::Gt(before, zero);
  const auto has_after = hn::Gt(after, zero);
  const auto step =
      hn::Sub(hn::IfThenElse(has_after, after, center), hn::IfThenElse(has_before, before, center));
  const auto scale =
      hn::IfThenElse(hn::And(has_before, has_after), hn::Set(d, 0.5f), hn::Set(d, 1.0f));
  return hn::Mul(step, scale);
}

// 2^x to a relative 1e-7, for -126 <= x < 128. The whole part of x goes to the exponent; the
// fraction, at most a half, goes through the minimax polynomial of degree five (largest relative
// error 7.5e-8, by Remez's method).
template <class D>
HWY_INLINE hn::Vec<D> PowerOfTwo(D d, hn::Vec<D> x) {
  const auto whole = hn::NearestInt(x);
  const auto rest = hn::Sub(x, hn::ConvertTo(d, whole));
  auto power = hn::Set(d, 1.3276472e-3f);
  for (const float c :
       {9.67554133e-3f, 5.55071327e-2f, 2.40221197e-1f, 6.93146967e-1f, 1.00000007f})
    power = hn::MulAdd(power, rest, hn::Set(d, c));
  const hn::RebindToSigned<D> di;
  return hn::BitCast(d, hn::Add(hn::BitCast(di, power), hn::ShiftLeft<23>(whole)));
}

// eq:supp_observation_quality with 1 - tanh(x) = 2 / (1 + e^2x), which keeps relative precision.
template <class D>
HWY_INLINE void QualityAt(D d, const DepthRows& depth, int u, const QualityFactors& f,
                          float* HWY_RESTRICT quality) {
  const auto center = hn::LoadU(d, depth.row + u + 1);
  const auto gx = Gradient(d, hn::LoadU(d, depth.row + u), center, hn::LoadU(d, depth.row + u + 2));
  const auto gy =
      Gradient(d, hn::LoadU(d, depth.above + u + 1), center, hn::LoadU(d, depth.below + u + 1));
  const auto norm = hn::Sqrt(hn::Add(hn::Mul(gx, gx), hn::Mul(gy, gy)));
  // 2^87 is far above any relevant value and far below overflow.
  const auto x2 = hn::Min(hn::Mul(norm, hn::Set(d, f.gradient)), hn::Set(d, 87.0f));
  const auto off = hn::Sub(hn::Set(d, f.preferred_m), center);
  const auto e =
      hn::Max(hn::Mul(hn::Mul(off, off), hn::Set(d, -f.inverse_spread)), hn::Set(d, -115.0f));
  const auto faded = PowerOfTwo(d, e);
  const auto q = hn::Div(hn::Add(faded, faded), hn::Add(hn::Set(d, 1.0f), PowerOfTwo(d, x2)));
  hn::StoreU(hn::IfThenElseZero(hn::Gt(center, hn::Zero(d)), q), d, quality + u);
}

void QualityOfRow(const DepthRows& depth, int width, const QualityFactors& f, float* quality) {
  const Wide d;
  const Single d1;
  int u = 0;
  for (; u + static_cast<int>(kLanes) <= width; u += kLanes) QualityAt(d, depth, u, f, quality);
  for (; u < width; ++u) QualityAt(d1, depth, u, f, quality);
}

const char* Target() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace crossnav::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossnav::memory {

HWY_EXPORT(FuseHalf);
HWY_EXPORT(FuseFloat);
HWY_EXPORT(DotHalf);
HWY_EXPORT(DotFloat);
HWY_EXPORT(DotCompact);
HWY_EXPORT(ConvertToCompact);
HWY_EXPORT(ConvertFromCompact);
HWY_EXPORT(ConvertToHalf);
HWY_EXPORT(ConvertFromHalf);
HWY_EXPORT(CheckFinite);
HWY_EXPORT(CopyValid);
HWY_EXPORT(QualityOfRow);
HWY_EXPORT(Target);

float FuseRow(std::uint16_t* row, int dim, float keep, const float* grid,
              std::span<const CellShare> shares) {
  return HWY_DYNAMIC_DISPATCH(FuseHalf)(row, dim, keep, grid, shares);
}
float FuseRow(float* row, int dim, float keep, const float* grid,
              std::span<const CellShare> shares) {
  return HWY_DYNAMIC_DISPATCH(FuseFloat)(row, dim, keep, grid, shares);
}
void PrefetchBytes(const std::byte* begin, std::size_t bytes) {
  constexpr std::size_t kCacheLine = 64;
  // Prefetches into the second-level cache, which allows more outstanding lines than the first.
  constexpr int kToRead = 0, kSecondCache = 2;
  for (std::size_t i = 0; i < bytes; i += kCacheLine)
    __builtin_prefetch(begin + i, kToRead, kSecondCache);
}
void DotRows(const std::uint16_t* rows, int stride, std::size_t count, const float* text,
             float* out) {
  HWY_DYNAMIC_DISPATCH(DotHalf)(rows, stride, count, text, out);
}
void DotRows(const float* rows, int stride, std::size_t count, const float* text, float* out) {
  HWY_DYNAMIC_DISPATCH(DotFloat)(rows, stride, count, text, out);
}
void DotRows(const std::int8_t* rows, int stride, std::size_t count, const std::int16_t* text,
             std::int32_t* out) {
  HWY_DYNAMIC_DISPATCH(DotCompact)(rows, stride, count, text, out);
}
float ToCompact(std::span<const float> in, std::int8_t* out) {
  float largest = 0;
  for (float x : in) largest = std::max(largest, std::abs(x));
  // Rows below this count as zero: 127 / largest would overflow.
  constexpr float kNothing = 1e-30f;
  const bool is_zero = largest <= kNothing;
  HWY_DYNAMIC_DISPATCH(ConvertToCompact)(in, is_zero ? 0 : 127 / largest, out);
  return is_zero ? 1 : largest / 127;
}
void FromCompact(std::span<const std::int8_t> in, float scale, float* out) {
  HWY_DYNAMIC_DISPATCH(ConvertFromCompact)(in, scale, out);
}
void ToHalf(std::span<const float> in, std::uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(ConvertToHalf)(in, out);
}
void FromHalf(std::span<const std::uint16_t> in, float* out) {
  HWY_DYNAMIC_DISPATCH(ConvertFromHalf)(in, out);
}
bool AllFinite(std::span<const float> values) {
  return HWY_DYNAMIC_DISPATCH(CheckFinite)(values);
}
void CopyValidDepth(const float* in, int width, float* out) {
  HWY_DYNAMIC_DISPATCH(CopyValid)(in, width, out);
}

void QualityRow(const DepthRows& depth, int width, const QualityFactors& factors, float* quality) {
  HWY_DYNAMIC_DISPATCH(QualityOfRow)(depth, width, factors, quality);
}
const char* KernelTarget() {
  return HWY_DYNAMIC_DISPATCH(Target)();
}

}  // namespace crossnav::memory
#endif  // HWY_ONCE
