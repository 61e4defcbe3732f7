// SPDX-License-Identifier: MIT
// Golden values come from a separate implementation of PCG32 (XSH-RR) and SplitMix64 written from
// their published definitions. They hold every seed of the project in place.
#include "crossnav/core/rng.h"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace crossnav {
namespace {

std::array<std::uint32_t, 4> FirstFour(Rng rng) {
  std::array<std::uint32_t, 4> values{};
  for (auto& value : values) value = rng.Next();
  return values;
}

TEST(Rng, SeedsGiveTheGoldenNumbers) {
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(FirstFour(Rng(0)), (Four{2743582916u, 2268865480u, 3616064773u, 2405507820u}));
  EXPECT_EQ(FirstFour(Rng(1)), (Four{2731431406u, 1069114489u, 301084815u, 4006664735u}));
  EXPECT_EQ(FirstFour(Rng(42)), (Four{3174250855u, 494131186u, 597240385u, 435331665u}));
  EXPECT_EQ(FirstFour(Rng(42, 7)), (Four{851889987u, 1039061325u, 2341589682u, 1512363413u}));
}

TEST(Rng, UniformNumbersEqualTheGoldenNumbersToTheLastBit) {
  Rng rng(42);
  EXPECT_EQ(rng.Uniform(), 0.7390628689158624);
  EXPECT_EQ(rng.Uniform(), 0.1390558637779843);
  EXPECT_EQ(rng.Uniform(), 0.19615852706510295);
}

TEST(Rng, MixedSeedsAndHashesEqualTheGoldenValues) {
  EXPECT_EQ(MixSeed(1, 2), 13608149317741381227u);
  EXPECT_NE(MixSeed(1, 2), MixSeed(2, 1));
  // FNV-1a's published test vectors.
  EXPECT_EQ(HashString(""), 0xcbf29ce484222325u);
  EXPECT_EQ(HashString("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(HashString("foobar"), 0x85944171f73967e8u);
}

TEST(Rng, BelowIsUniformAndInRange) {
  Rng rng(5);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) {
    const std::uint32_t value = rng.Below(7);
    ASSERT_LT(value, 7u);
    ++counts[value];
  }
  // Six standard deviations of a binomial with p = 1/7.
  for (const int count : counts) EXPECT_NEAR(count, 10000, 560);
}

TEST(Rng, IntReachesBothEnds) {
  Rng rng(9);
  std::set<int> seen;
  for (int i = 0; i < 500; ++i) seen.insert(rng.Int(-2, 3));
  EXPECT_EQ(seen, (std::set<int>{-2, -1, 0, 1, 2, 3}));
}

TEST(Rng, NormalNumbersHaveMeanZeroAndVarianceOne) {
  Rng rng(11);
  double sum = 0, squares = 0;
  constexpr int kCount = 40000;
  for (int i = 0; i < kCount; ++i) {
    const double x = rng.Normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.03);
  EXPECT_NEAR(squares / kCount, 1, 0.05);
}

TEST(Rng, ShuffleKeepsTheElements) {
  Rng rng(13);
  std::vector<int> numbers(50);
  for (int i = 0; i < 50; ++i) numbers[static_cast<std::size_t>(i)] = i;
  const auto before = numbers;
  rng.Shuffle(numbers);
  EXPECT_NE(numbers, before);
  std::sort(numbers.begin(), numbers.end());
  EXPECT_EQ(numbers, before);
}

}  // namespace
}  // namespace crossnav
