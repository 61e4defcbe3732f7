// SPDX-License-Identifier: MIT
#include "crossnav/memory/row_kernels.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <limits>
#include <vector>

#include "crossnav/core/rng.h"

namespace crossnav::memory {
namespace {

struct KernelResult {
  std::vector<std::uint16_t> row;
  std::vector<float> dots, quality;
  std::vector<std::int8_t> compact;
  std::vector<std::int32_t> compact_dots;
  std::vector<float> expanded;
  float squared_norm = 0;
};

KernelResult RunAll(int dim) {
  Rng rng(static_cast<std::uint64_t>(dim));
  const int stride = RowStride(dim);
  std::vector<float> grid(static_cast<std::size_t>(6) * dim), text(stride, 0.0f);
  for (float& x : grid) x = static_cast<float>(rng.Normal());
  for (int i = 0; i < dim; ++i) text[i] = static_cast<float>(rng.Normal());
  const std::vector<CellShare> shares = {{0, 0.2f}, {3, 0.5f}, {5, 0.1f}};
  KernelResult out;
  out.row.resize(static_cast<std::size_t>(7) * stride);
  for (int r = 0; r < 7; ++r) {
    std::uint16_t* row = &out.row[static_cast<std::size_t>(r) * stride];
    FuseRow(row, dim, 0, grid.data(), shares);
    out.squared_norm = FuseRow(row, dim, 0.3f, grid.data(), {&shares[r % 3], 1});
  }
  out.dots.resize(7);
  DotRows(out.row.data(), stride, 7, text.data(), out.dots.data());
  out.compact.resize(out.row.size());
  out.expanded.resize(out.row.size());
  std::vector<float> values(out.row.size());
  FromHalf(out.row, values.data());
  const float scale = ToCompact(values, out.compact.data());
  FromCompact(out.compact, scale, out.expanded.data());
  std::vector<std::int16_t> whole(stride, 0);
  for (int i = 0; i < dim; ++i) whole[i] = static_cast<std::int16_t>(1000 * text[i]);
  out.compact_dots.resize(7);
  DotRows(out.compact.data(), stride, 7, whole.data(), out.compact_dots.data());
  std::vector<float> depth(static_cast<std::size_t>(dim) + 2, 0.0f);
  for (int i = 1; i <= dim; ++i) depth[i] = static_cast<float>(rng.Uniform(0.5, 5));
  out.quality.resize(dim);
  QualityRow({depth.data(), depth.data(), depth.data()}, dim, {0.4f, 1.0f, 0.15f},
             out.quality.data());
  return out;
}

TEST(RowKernelsTest, InstructionSetsWithFusedMultiplyAddGiveTheSameBytes) {
#if HWY_ARCH_X86
  const std::int64_t all = hwy::SupportedTargets();
  int compared = 0;
  for (int dim : {32, 100, 768}) {
    const KernelResult expected = RunAll(dim);
    for (const std::int64_t target :
         {static_cast<std::int64_t>(HWY_AVX2), static_cast<std::int64_t>(HWY_AVX3)}) {
      if ((all & target) == 0) continue;
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().DeInit();
      EXPECT_STREQ(KernelTarget(), hwy::TargetName(target));
      const KernelResult other = RunAll(dim);
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().DeInit();
      EXPECT_EQ(other.row, expected.row);
      EXPECT_EQ(other.dots, expected.dots);
      EXPECT_EQ(other.quality, expected.quality);
      EXPECT_EQ(other.compact, expected.compact);
      EXPECT_EQ(other.compact_dots, expected.compact_dots);
      EXPECT_EQ(other.expanded, expected.expanded);
      EXPECT_EQ(other.squared_norm, expected.squared_norm);
      ++compared;
    }
  }
  if (compared == 0) GTEST_SKIP() << "neither AVX2 nor AVX-512 here";
#else
  GTEST_SKIP() << "x86 only";
#endif
}

TEST(RowKernelsTest, WholeNumberProductsAreExactUpToTheLargestText) {
  Rng rng(4);
  for (int dim : {1, 31, 32, 100, 768, 4096}) {
    const int stride = RowStride(dim);
    std::vector<std::int8_t> rows(static_cast<std::size_t>(3) * stride, 0);
    std::vector<std::int16_t> text(stride, 0);
    // Row 0 takes the sum to its limit, row 1 to minus that, row 2 anywhere.
    const int largest = std::min(32767, kMaxCompactText / dim);
    for (int i = 0; i < dim; ++i) {
      text[i] = static_cast<std::int16_t>(i % 2 == 0 ? largest : -largest);
      rows[i] = static_cast<std::int8_t>(i % 2 == 0 ? 127 : -127);
      rows[stride + i] = static_cast<std::int8_t>(-rows[i]);
      rows[2 * stride + i] = static_cast<std::int8_t>(rng.Int(-127, 127));
    }
    std::vector<std::int32_t> dots(3);
    DotRows(rows.data(), stride, 3, text.data(), dots.data());
    for (int r = 0; r < 3; ++r) {
      std::int64_t expected = 0;
      for (int i = 0; i < stride; ++i) expected += std::int64_t{rows[r * stride + i]} * text[i];
      EXPECT_EQ(dots[r], expected) << dim;
    }
  }
}

TEST(RowKernelsTest, HalfRoundTripIsExactForHalvesAndSaturatesAtTheLargest) {
  std::vector<std::uint16_t> bits, back;
  for (int i = 0; i < 0x7c00; ++i) bits.push_back(static_cast<std::uint16_t>(i));
  std::vector<float> values(bits.size());
  FromHalf(bits, values.data());
  back.resize(bits.size());
  ToHalf(values, back.data());
  EXPECT_EQ(back, bits);
  EXPECT_EQ(values[0x3c00], 1.0f);
  EXPECT_EQ(values[1], std::ldexp(1.0f, -24));
  const std::vector<float> huge = {1e9f, -1e9f};
  std::vector<std::uint16_t> half(2);
  ToHalf(huge, half.data());
  EXPECT_EQ(half[0], 0x7bff);
  EXPECT_EQ(half[1], 0xfbff);
}

TEST(RowKernelsTest, AllFiniteFindsOneBadValueAnywhere) {
  for (int size : {1, 15, 16, 33, 100}) {
    std::vector<float> v(size, 1.5f);
    EXPECT_TRUE(AllFinite(v));
    for (int at = 0; at < size; ++at)
      for (float bad :
           {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        v[at] = bad;
        EXPECT_FALSE(AllFinite(v));
        v[at] = 1.5f;
      }
  }
}

}  // namespace
}  // namespace crossnav::memory
