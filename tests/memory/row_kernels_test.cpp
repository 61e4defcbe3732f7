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
      EXPECT_EQ(other.squared_norm, expected.squared_norm);
      ++compared;
    }
  }
  if (compared == 0) GTEST_SKIP() << "neither AVX2 nor AVX-512 here";
#else
  GTEST_SKIP() << "x86 only";
#endif
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
