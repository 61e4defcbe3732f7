// SPDX-License-Identifier: MIT
// The memory under fusion.max_rows: compaction, dropping, and their cost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/memory/row_kernels.h"
#include "crossnav/memory/row_store.h"
#include "crossnav/memory/semantic_memory.h"
#include "memory/literal_memory.h"
#include "memory/test_frames.h"

namespace crossnav::memory {
namespace {

using testing::CosineOf;
using testing::FuseFrame;
using testing::MakeFrame;
using testing::TestFrame;

FusionConfig Bounded(int max_rows, const char* storage = "half") {
  FusionConfig config;
  config.max_rows = max_rows;
  config.storage = storage;
  return config;
}

bool IsCompact(const SemanticMemory& memory, std::int64_t row) {
  return !memory.RowAt(row).compact.empty();
}

/// A frame without pixels: the limit is looked at, nothing else happens.
void FuseNothing(SemanticMemory& memory) {
  const CameraIntrinsics camera = IntrinsicsFromHfov(8, 8, 1.4);
  const std::vector<float> data(memory.Dim(), 1.0f);
  memory.Fuse({}, DepthImage(8, 8), camera, Pose::Identity(), {1, 1, memory.Dim(), data});
}

MemoryRow RandomRow(Rng& rng, const VoxelKey& key, int dim, float weight) {
  std::vector<float> f(dim);
  for (float& x : f) x = static_cast<float>(rng.Normal());
  MemoryRow row;
  row.key = key;
  row.weight = weight;
  row.half.resize(dim);
  ToHalf(f, row.half.data());
  return row;
}

TEST(BoundedMemoryTest, TheLeastConfidentRowsBecomeInt8AndNoneIsLost) {
  for (const char* storage : {"half", "float"}) {
    Rng rng(6);
    const TestFrame frame = MakeFrame(40, 30, 4, 4, 64, rng);
    SemanticMemory all(Bounded(0, storage));
    FuseFrame(all, frame);
    const auto limit = static_cast<int>(all.Size() * 8 / 10);
    SemanticMemory few(Bounded(limit, storage));
    FuseFrame(few, frame);
    ASSERT_EQ(few.Size(), all.Size());
    const MemoryCounters counters = few.Counters();
    EXPECT_EQ(counters.dropped_rows, 0);
    EXPECT_EQ(counters.compacted_rows, 2 * (all.Size() - (limit - limit / 10)));
    float strongest_compact = 0, weakest_full = 1e9f;
    std::int64_t compact = 0;
    for (std::int64_t row = 0; row < few.Size(); ++row) {
      ASSERT_EQ(few.Keys()[row], all.Keys()[row]);
      ASSERT_EQ(few.WeightAt(row), all.WeightAt(row));
      if (!IsCompact(few, row)) {
        weakest_full = std::min(weakest_full, few.WeightAt(row));
        ASSERT_EQ(few.FeatureAt(row), all.FeatureAt(row));
        continue;
      }
      ++compact;
      strongest_compact = std::max(strongest_compact, few.WeightAt(row));
      ASSERT_GT(CosineOf(few.FeatureAt(row), all.FeatureAt(row)), 1 - 1e-3);
    }
    EXPECT_EQ(compact, counters.compacted_rows);
    EXPECT_LE(strongest_compact, weakest_full);
  }
}

TEST(BoundedMemoryTest, RowsAreDroppedOnlyWhenInt8IsNotEnoughAndAreCounted) {
  Rng rng(6);
  std::vector<TestFrame> frames;
  for (int i = 0; i < 4; ++i) frames.push_back(MakeFrame(40, 30, 4, 4, 16, rng));
  for (TestFrame& f : frames) f.grid.data = f.data;
  SemanticMemory all, few(Bounded(200));
  FuseFrame(all, frames[0]);
  FuseFrame(few, frames[0]);
  ASSERT_GT(all.Size(), 400);
  EXPECT_EQ(few.Size(), 360);  // twice nine tenths of the limit
  EXPECT_EQ(few.Counters().compacted_rows, 360);
  EXPECT_EQ(few.Counters().dropped_rows, all.Size() - 360);
  float weakest_kept = 1e9f;
  for (std::int64_t row = 0; row < few.Size(); ++row) {
    weakest_kept = std::min(weakest_kept, few.WeightAt(row));
    EXPECT_EQ(few.RowOf(few.Keys()[row]), row);
  }
  for (std::int64_t row = 0; row < all.Size(); ++row)
    if (!few.RowOf(all.Keys()[row])) {
      EXPECT_LE(all.WeightAt(row), weakest_kept);
    }
  for (const TestFrame& f : frames) {
    FuseFrame(few, f);
    EXPECT_LE(2 * few.Size() - few.Counters().compacted_rows, 2 * 200);
  }
}

TEST(BoundedMemoryTest, ManyFramesUnderALimitKeepRowsFactsAndFeaturesTogether) {
  Rng rng(16);
  SemanticMemory all, few(Bounded(700));
  for (int i = 0; i < 30; ++i) {
    const TestFrame f = MakeFrame(40, 30, 4, 5, 48, rng);
    FuseFrame(all, f);
    FuseFrame(few, f);
    ASSERT_LE(2 * few.Size() - few.Counters().compacted_rows, 2 * 700) << "frame " << i;
  }
  EXPECT_GT(few.Counters().dropped_rows, 0);
  std::set<VoxelKey> keys(few.Keys().begin(), few.Keys().end());
  ASSERT_EQ(static_cast<std::int64_t>(keys.size()), few.Size());
  int same = 0;
  for (std::int64_t row = 0; row < few.Size(); ++row) {
    ASSERT_EQ(few.RowOf(few.Keys()[row]), row);
    // A voxel that was dropped and came back has less evidence; the others equal `all`.
    const std::int64_t other = *all.RowOf(few.Keys()[row]);
    if (std::abs(few.WeightAt(row) / all.WeightAt(other) - 1) > 1e-4) continue;
    ++same;
    ASSERT_GT(CosineOf(few.FeatureAt(row), all.FeatureAt(other)), 1 - 1e-2);
  }
  EXPECT_GT(same, 200);
  const std::vector<float> text(48, 0.4f), field = few.Similarity(text);
  for (std::int64_t row = 0; row < few.Size(); ++row)
    ASSERT_NEAR(field[row], CosineOf(few.FeatureAt(row), text), 1e-4);
}

TEST(BoundedMemoryTest, ACompactRowThatIsSeenAgainIsFullAgain) {
  Rng rng(7);
  const TestFrame frame = MakeFrame(40, 30, 4, 4, 64, rng);
  SemanticMemory all;
  FuseFrame(all, frame);
  SemanticMemory few(Bounded(static_cast<int>(all.Size() * 8 / 10)));
  FuseFrame(few, frame);
  std::int64_t row = 0;
  while (!IsCompact(few, row)) ++row;
  TestFrame again = frame;
  again.grid.data = again.data;
  std::erase_if(again.pixels, [&](const PixelVoxel& p) { return p.key != few.Keys()[row]; });
  ASSERT_FALSE(again.pixels.empty());
  const std::int64_t before = few.Counters().compacted_rows;
  for (float& x : again.data) x = static_cast<float>(rng.Normal());
  FuseFrame(few, again);
  FuseFrame(all, again);
  EXPECT_FALSE(IsCompact(few, row));
  EXPECT_EQ(few.Counters().compacted_rows, before - 1);
  EXPECT_EQ(few.WeightAt(row), all.WeightAt(row));
  EXPECT_GT(CosineOf(few.FeatureAt(row), all.FeatureAt(row)), 1 - 1e-3);
  for (std::int64_t other = 0; other < few.Size(); ++other)  // the rest is where it was
    ASSERT_GT(CosineOf(few.FeatureAt(other), all.FeatureAt(other)), 1 - 1e-3);
}

TEST(BoundedMemoryTest, AmongEqualWeightsTheKeyDecidesNotTheOrderOfArrival) {
  Rng rng(3);
  std::vector<MemoryRow> rows;
  for (int i = 0; i < 300; ++i) rows.push_back(RandomRow(rng, {i % 17, i, -i}, 32, 1.0f));
  const auto compacted_of = [&](int limit) {
    SemanticMemory memory(Bounded(limit));
    for (const MemoryRow& row : rows) memory.AppendRow(row);
    FuseNothing(memory);
    std::set<std::pair<VoxelKey, bool>> out;
    for (std::int64_t row = 0; row < memory.Size(); ++row)
      out.emplace(memory.Keys()[row], IsCompact(memory, row));
    return out;
  };
  const auto a = compacted_of(250), b = compacted_of(100);
  std::reverse(rows.begin(), rows.end());
  EXPECT_EQ(compacted_of(250), a);
  EXPECT_EQ(compacted_of(100), b);
  EXPECT_EQ(a.size(), 300u);
  EXPECT_EQ(b.size(), 180u);
}

TEST(BoundedMemoryTest, SimilarityOfInt8RowsIsTheirCosineAtAnyDimension) {
  for (int dim : {8, 37, 512, 640, 768, 4096}) {
    Rng rng(static_cast<std::uint64_t>(dim));
    RowStore store(true, dim);
    std::vector<float> text(dim);
    for (float& x : text) x = static_cast<float>(rng.Normal());
    for (int i = 0; i < 40; ++i) {
      store.Append();
      store.WriteHalf(i, RandomRow(rng, {}, dim, 1).half);
      if (i % 3 != 0) store.Compact(i);
    }
    const std::vector<float> cosines = store.Cosines(text);
    for (int i = 0; i < 40; ++i)
      EXPECT_NEAR(cosines[i], CosineOf(store.Read(i), text), 2e-5) << dim;
    // Texts of one number, of equal numbers, of norm 0.
    std::vector<float> one(dim, 0.0f), flat(dim, -1.0f);
    one[dim / 2] = 3;
    const std::vector<float> to_one = store.Cosines(one), to_flat = store.Cosines(flat);
    for (int i = 0; i < 40; ++i) {
      EXPECT_NEAR(to_one[i], CosineOf(store.Read(i), one), 2e-5) << dim;
      EXPECT_NEAR(to_flat[i], CosineOf(store.Read(i), flat), 1e-4) << dim;
    }
    for (float c : store.Cosines(std::vector<float>(dim, 0.0f))) EXPECT_EQ(c, 0.0f);
  }
}

TEST(BoundedMemoryTest, CosineErrorOfInt8StaysUnderItsBoundEvenForTheWorstRow) {
  constexpr int kDim = 768;
  const auto error_of = [](const std::vector<float>& values) {
    std::vector<std::int8_t> whole(kDim);
    std::vector<float> back(kDim);
    FromCompact(whole, ToCompact(values, whole.data()), back.data());
    return 1 - CosineOf(values, back);
  };
  Rng rng(1);
  double typical = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<float> row(kDim);
    for (float& x : row) x = static_cast<float>(rng.Normal());
    row[rng.Below(kDim)] *= static_cast<float>(1 + i % 8);  // an outlier, as networks have them
    typical = std::max(typical, error_of(row));
  }
  EXPECT_LT(typical, 1.5e-3);
  // One large value, all others half a step: they are all rounded away.
  std::vector<float> worst(kDim, 0.4999f / 127);
  worst[0] = 1;
  EXPECT_GT(error_of(worst), 1e-3);
  EXPECT_LT(error_of(worst), kDim / 125000.0);
  EXPECT_LT(kDim / 125000.0, 1e-2);
  const std::vector<float> zero(kDim, 0.0f);
  std::vector<std::int8_t> whole(kDim, 1);
  EXPECT_EQ(ToCompact(zero, whole.data()), 1.0f);
  EXPECT_EQ(std::count(whole.begin(), whole.end(), 0), kDim);
}

TEST(BoundedMemoryTest, RowsTakenOutAndPutBackAreTheSame) {
  Rng rng(8);
  const TestFrame f = MakeFrame(40, 30, 6, 8, 100, rng);
  const FusionConfig config = Bounded(500);
  SemanticMemory memory(config);
  FuseFrame(memory, f);
  ASSERT_GT(memory.Counters().compacted_rows, 0);
  SemanticMemory copy(config);
  for (std::int64_t row = 0; row < memory.Size(); ++row) copy.AppendRow(memory.RowAt(row));
  copy.AddDropped(memory.Counters().dropped_rows);
  for (int pass = 0; pass < 2; ++pass) {
    ASSERT_EQ(copy.Size(), memory.Size());
    for (std::int64_t row = 0; row < memory.Size(); ++row)
      ASSERT_TRUE(copy.RowAt(row) == memory.RowAt(row)) << row;
    EXPECT_EQ(copy.Similarity(std::vector<float>(100, 0.3f)),
              memory.Similarity(std::vector<float>(100, 0.3f)));
    EXPECT_EQ(copy.Counters().dropped_rows, memory.Counters().dropped_rows);
    FuseFrame(memory, f);
    FuseFrame(copy, f);
  }
  std::vector<std::int64_t> order(memory.Size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = (static_cast<std::int64_t>(i) * 7 + 3) % memory.Size();
  ASSERT_NE(memory.Size() % 7, 0);
  copy.ReorderRows(order);
  for (std::int64_t row = 0; row < memory.Size(); ++row)
    ASSERT_TRUE(copy.RowAt(row) == memory.RowAt(order[row]));
}

TEST(BoundedMemoryTest, Int8HalvesTheBytes) {
  Rng rng(2);
  RowStore store(true, 256);
  const MemoryRow row = RandomRow(rng, {}, 256, 1);
  for (int i = 0; i < 40960; ++i) {
    store.Append();
    store.WriteHalf(i, row.half);
  }
  const std::int64_t before = store.Bytes();
  for (int i = 0; i < 40960; ++i) store.Compact(i);
  EXPECT_LT(static_cast<double>(store.Bytes()), 0.7 * static_cast<double>(before));
}

}  // namespace
}  // namespace crossnav::memory
