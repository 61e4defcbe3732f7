// SPDX-License-Identifier: MIT
#include "crossnav/memory/query_match.h"

#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/core/rng.h"
#include "crossnav/memory/row_kernels.h"

namespace crossnav::memory {
namespace {

constexpr int kMatchDim = 256;

std::vector<float> Unit(Rng& rng) {
  std::vector<float> v(kMatchDim);
  double squared = 0;
  for (float& x : v) {
    x = static_cast<float>(rng.Normal());
    squared += static_cast<double>(x) * x;
  }
  for (float& x : v) x /= static_cast<float>(std::sqrt(squared));
  return v;
}

/// Words with a common part, and cells that show one of them.
struct Words {
  SemanticMemory memory;
  Rng rng{3};
  double common_share;
  std::vector<float> common = Unit(rng);

  explicit Words(double share) : common_share(share) {}
  std::vector<float> Word() {
    std::vector<float> v = Unit(rng);
    for (int i = 0; i < kMatchDim; ++i) {
      v[i] = static_cast<float>(std::sqrt(common_share) * common[i] +
                                std::sqrt(1 - common_share) * v[i]);
    }
    return v;
  }
  /// A block of `side` voxels from `at` on.
  void Show(const std::vector<float>& word, const VoxelKey& at, int side) {
    for (int i = 0; i < side * side * side; ++i) {
      std::vector<float> noise = Unit(rng), f = word;
      for (int k = 0; k < kMatchDim; ++k) f[k] += 0.2F * noise[k];
      MemoryRow row{at + VoxelKey{i % side, i / side % side, i / side / side}, 1.0F, 1.0F,
                    Vector3f::Zero(), std::vector<std::uint16_t>(kMatchDim)};
      ToHalf(f, row.half.data());
      memory.AppendRow(row);
    }
  }
  QueryMatch Ask(const std::vector<float>& word) {
    return MatchOf(memory, word, Query(memory, word, {}));
  }
};

TEST(QueryMatch, ScaleIsTheSameHoweverMuchAllWordsHaveInCommon) {
  for (const double share : {0.0, 0.5, 0.7}) {
    SCOPED_TRACE(share);
    Words w(share);
    const auto wall = w.Word(), chair = w.Word(), zebra = w.Word();
    w.Show(wall, {0, 0, 0}, 12);
    w.Show(chair, {40, 0, 0}, 5);
    w.Show(w.Word(), {80, 0, 0}, 8);
    const QueryMatch there = w.Ask(chair), none = w.Ask(zebra);
    ASSERT_FALSE(there.places.empty());
    EXPECT_GT(there.best, 0.8);
    EXPECT_LE(there.best, 1.0);
    EXPECT_LT(none.best, 0.3);
    EXPECT_NEAR(there.chance, share, 0.15);
  }
}

TEST(QueryMatch, SurfacesThatFillTheMapArePresentWithoutAnOutstandingPlace) {
  Words w(0.5);
  const auto wall = w.Word();
  w.Show(wall, {0, 0, 0}, 12);
  w.Show(w.Word(), {40, 0, 0}, 7);
  const QueryMatch match = w.Ask(wall);
  EXPECT_TRUE(match.places.empty());
  EXPECT_EQ(Judge(match, ThresholdsOf("ground-truth")), Verdict::kPresent);
}

TEST(QueryMatch, IsUnknownBetweenTheThresholds) {
  const MatchThresholds thresholds{0.4, 0.6};
  EXPECT_EQ(Judge({0, 0.39, {}}, thresholds), Verdict::kAbsent);
  EXPECT_EQ(Judge({0, 0.4, {}}, thresholds), Verdict::kUnknown);
  EXPECT_EQ(Judge({0, 0.59, {}}, thresholds), Verdict::kUnknown);
  EXPECT_EQ(Judge({0, 0.6, {}}, thresholds), Verdict::kPresent);
}

TEST(QueryMatch, AnEmptyMemoryHoldsNothingAndAnUnmeasuredEncoderIsNotJudged) {
  const SemanticMemory nothing;
  const QueryMatch match = MatchOf(nothing, std::vector<float>(kMatchDim, 1.0F), {});
  EXPECT_EQ(match.best, 0);
  EXPECT_EQ(Judge(match, ThresholdsOf("ground-truth")), Verdict::kAbsent);
  EXPECT_EQ(Judge(match, ThresholdsOf("somebody-elses")), Verdict::kUnknown);
}

}  // namespace
}  // namespace crossnav::memory
