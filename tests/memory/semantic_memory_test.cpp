// SPDX-License-Identifier: MIT
#include "crossnav/memory/semantic_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "crossnav/core/rng.h"
#include "memory/golden_file.h"
#include "memory/literal_memory.h"
#include "memory/test_frames.h"

namespace crossnav::memory {
namespace {

using testing::FloatRows;
using testing::FuseFrame;
using testing::MakeFrame;
using testing::TestFrame;

testing::LiteralFactors FactorsOf(const TestFrame& f) {
  testing::LiteralFactors factors;
  factors.gradient_scale = f.camera.width_px / 640.0 * f.camera.width_px / f.camera.fx;
  return factors;
}

TEST(SemanticMemoryTest, EqualsTheGoldenVectors) {
  const auto golden = testing::ReadGolden("fusion.json");
  if (!golden) GTEST_SKIP() << "no golden vectors beside the project";
  const auto& g = *golden;
  FusionConfig config = FloatRows();
  config.gamma = g["gamma"];
  config.preferred_depth_m = g["d0_m"];
  config.depth_scale_m = g["sigma_m"];
  config.epsilon = g["epsilon"];
  config.gradient_scale = g["gradient_scale"];
  const double voxel_m = g["voxel_size_m"];
  SemanticMemory memory(config, voxel_m);
  config.storage = "half";
  SemanticMemory half(config, voxel_m);
  for (const auto& frame : g["frames"]) {
    const DepthImage depth = testing::DepthOf(frame["depth"]);
    const auto& K = g["intrinsics"];
    const CameraIntrinsics camera{depth.width, depth.height, K["fx"], K["fy"], K["cx"], K["cy"]};
    Pose T_world_camera;
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) T_world_camera.matrix()(r, c) = frame["T_world_camera"][r][c];
    std::vector<float> data;
    for (const auto& row : frame["grid"])
      for (const auto& cell : row)
        for (const auto& x : cell) data.push_back(x.get<float>());
    const auto& cells = frame["grid"];
    const FeatureGridView grid{static_cast<int>(cells.size()), static_cast<int>(cells[0].size()),
                               static_cast<int>(cells[0][0].size()), data};
    const auto pixels = testing::EndVoxels(depth, camera, T_world_camera, voxel_m);
    memory.Fuse(pixels, depth, camera, T_world_camera, grid);
    half.Fuse(pixels, depth, camera, T_world_camera, grid);
  }
  std::vector<float> text;
  for (const auto& x : g["text"]) text.push_back(x.get<float>());
  const std::vector<float> similarity = memory.Similarity(text);
  const std::vector<float> half_similarity = half.Similarity(text);
  ASSERT_EQ(memory.Size(), static_cast<std::int64_t>(g["voxels"].size()));
  for (const auto& voxel : g["voxels"]) {
    const auto row = memory.RowOf({voxel["index"][0], voxel["index"][1], voxel["index"][2]});
    ASSERT_TRUE(row.has_value());
    const auto expected = voxel["feature"].get<std::vector<double>>();
    EXPECT_LT(testing::RelativeError(memory.FeatureAt(*row), expected), 1e-5);
    EXPECT_NEAR(memory.WeightAt(*row) / voxel["weight"].get<double>(), 1.0, 1e-5);
    EXPECT_NEAR(similarity[*row], voxel["similarity"].get<double>(), 1e-5);
    EXPECT_NEAR(half_similarity[*row], voxel["similarity"].get<double>(), 2e-3);
  }
}

struct Shape {
  int width, height, rows, cols, dim;
};

class LiteralReferenceTest : public ::testing::TestWithParam<Shape> {};

TEST_P(LiteralReferenceTest, FusionEqualsOnePixelAtATime) {
  const Shape s = GetParam();
  Rng rng(static_cast<std::uint64_t>(s.dim) * 31 + s.rows);
  SemanticMemory memory(FloatRows());
  SemanticMemory half;
  std::unique_ptr<testing::LiteralMemory> literal;
  for (int i = 0; i < 3; ++i) {
    const TestFrame f = MakeFrame(s.width, s.height, s.rows, s.cols, s.dim, rng);
    if (!literal) literal = std::make_unique<testing::LiteralMemory>(FactorsOf(f));
    FuseFrame(memory, f);
    FuseFrame(half, f);
    literal->Fuse(f.pixels, f.depth, f.grid);
  }
  ASSERT_EQ(memory.Size(), static_cast<std::int64_t>(literal->entries().size()));
  ASSERT_EQ(half.Size(), memory.Size());
  for (const auto& [key, entry] : literal->entries()) {
    const auto row = memory.RowOf(key);
    ASSERT_TRUE(row.has_value());
    ASSERT_LT(testing::RelativeError(memory.FeatureAt(*row), entry.feature), 1e-5);
    ASSERT_NEAR(memory.WeightAt(*row) / entry.weight, 1.0, 1e-5);
    ASSERT_GT(testing::CosineOf(half.FeatureAt(*half.RowOf(key)), entry.feature), 1 - 2e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, LiteralReferenceTest,
                         ::testing::Values(Shape{48, 40, 6, 7, 512}, Shape{40, 48, 24, 24, 768},
                                           Shape{33, 21, 5, 4, 640}, Shape{64, 48, 1, 1, 37},
                                           Shape{16, 12, 20, 30, 8}));

TEST(SemanticMemoryTest, OrderOfFramesDoesNotMatterBeyondRounding) {
  Rng rng(5);
  std::vector<TestFrame> frames;
  for (int i = 0; i < 6; ++i) {
    frames.push_back(MakeFrame(40, 30, 6, 8, 64, rng));
    frames.back().grid.data = frames.back().data;
  }
  SemanticMemory forward, backward;
  for (const TestFrame& f : frames) FuseFrame(forward, f);
  std::reverse(frames.begin(), frames.end());
  for (TestFrame& f : frames) f.grid.data = f.data;
  for (const TestFrame& f : frames) FuseFrame(backward, f);
  ASSERT_EQ(forward.Size(), backward.Size());
  for (std::int64_t row = 0; row < forward.Size(); ++row) {
    const auto other = backward.RowOf(forward.Keys()[row]);
    ASSERT_TRUE(other.has_value());
    EXPECT_NEAR(forward.WeightAt(row) / backward.WeightAt(*other), 1.0, 1e-5);
    EXPECT_GT(testing::CosineOf(forward.FeatureAt(row), backward.FeatureAt(*other)), 1 - 1e-5);
  }
}

TEST(SemanticMemoryTest, HowTheRunsAreCutChangesNothing) {
  Rng rng(12);
  const TestFrame f = MakeFrame(60, 40, 6, 8, 32, rng);
  std::vector<geometry::EndRun> single;
  for (const PixelVoxel& p : f.pixels) single.push_back({p.pixel, 1, p.key});
  const auto runs = geometry::RunsOf(f.pixels, f.depth.width);
  ASSERT_LT(runs.size(), single.size());
  SemanticMemory by_pixel(FloatRows()), by_run(FloatRows());
  by_pixel.FuseRuns(single, f.depth, f.camera, f.T_world_camera, f.grid);
  by_run.FuseRuns(runs, f.depth, f.camera, f.T_world_camera, f.grid);
  ASSERT_EQ(by_pixel.Size(), by_run.Size());
  for (std::int64_t row = 0; row < by_run.Size(); ++row) {
    EXPECT_EQ(by_pixel.Keys()[row], by_run.Keys()[row]);
    EXPECT_EQ(by_pixel.WeightAt(row), by_run.WeightAt(row));
    EXPECT_EQ(by_pixel.FeatureAt(row), by_run.FeatureAt(row));
  }
}

// Sums over runs are differences of sums over a whole interval of cells.
TEST(SemanticMemoryTest, FarPixelsBesideNearPixelsKeepTheirWeight) {
  const CameraIntrinsics camera = IntrinsicsFromHfov(64, 8, DegToRad(90));
  DepthImage depth(64, 8, 1.0F);
  for (int v = 0; v < 8; ++v)
    for (int u = 20; u < 23; ++u) depth.At(u, v) = 40.0F;
  const std::vector<float> data(2 * 2 * 4, 1.0F);
  SemanticMemory memory(FloatRows());
  const auto pixels = testing::EndVoxels(depth, camera, Pose::Identity(), 0.1);
  memory.Fuse(pixels, depth, camera, Pose::Identity(), {2, 2, 4, data});
  const Image<float> quality = ObservationQuality(depth, camera, FloatRows());
  std::map<VoxelKey, double> weights;
  for (const PixelVoxel& pixel : pixels) weights[pixel.key] += quality.data[pixel.pixel];
  ASSERT_EQ(memory.Size(), static_cast<std::int64_t>(weights.size()));
  for (const auto& [key, weight] : weights) {
    ASSERT_TRUE(memory.RowOf(key).has_value());
    EXPECT_NEAR(memory.WeightAt(*memory.RowOf(key)) / weight, 1, 1e-6);
  }
}

TEST(SemanticMemoryTest, HalfStorageStaysCloseOverManyFrames) {
  Rng rng(9);
  TestFrame f = MakeFrame(16, 12, 3, 4, 96, rng);
  SemanticMemory half;
  testing::LiteralMemory literal(FactorsOf(f));
  const std::vector<float> base = f.data;
  for (int i = 0; i < 400; ++i) {
    for (std::size_t k = 0; k < base.size(); ++k)
      f.data[k] = base[k] + static_cast<float>(rng.Normal());
    FuseFrame(half, f);
    literal.Fuse(f.pixels, f.depth, f.grid);
  }
  std::vector<float> text(96);
  for (float& x : text) x = static_cast<float>(rng.Normal());
  const std::vector<float> similarity = half.Similarity(text);
  for (const auto& [key, entry] : literal.entries()) {
    const auto row = half.RowOf(key);
    EXPECT_NEAR(similarity[*row], testing::CosineOf(text, entry.feature), 2e-3);
  }
}

TEST(SemanticMemoryTest, SimilarityIsTheCosineOfEveryRowForAnyNormOfTheText) {
  Rng rng(2);
  const TestFrame f = MakeFrame(40, 30, 6, 8, 640, rng);
  SemanticMemory memory;
  FuseFrame(memory, f);
  std::vector<float> text(640), scaled(640);
  for (int i = 0; i < 640; ++i) {
    text[i] = static_cast<float>(rng.Normal());
    scaled[i] = 100 * text[i];
  }
  const std::vector<float> a = memory.Similarity(text), b = memory.Similarity(scaled);
  ASSERT_EQ(static_cast<std::int64_t>(a.size()), memory.Size());
  for (std::int64_t row = 0; row < memory.Size(); ++row) {
    EXPECT_NEAR(a[row], testing::CosineOf(memory.FeatureAt(row), text), 1e-5);
    EXPECT_NEAR(a[row], b[row], 1e-6);
  }
}

TEST(SemanticMemoryTest, BestViewIsWhereTheVoxelWasSeenWithMostConfidence) {
  // The same wall at 4 m, then at 1 m, then at 4 m again: one voxel straight ahead.
  SemanticMemory memory;
  const CameraIntrinsics camera = IntrinsicsFromHfov(20, 20, 1.5);
  const std::vector<float> data(4, 1.0f);
  for (double x : {0.0, 3.0, 0.0}) {
    Pose T_world_camera = CameraPose({{x, 0, 0}, 0, 0}, 1.05);
    const DepthImage depth(20, 20, static_cast<float>(4.05 - x));
    const auto pixels = testing::EndVoxels(depth, camera, T_world_camera, 0.1);
    memory.Fuse(pixels, depth, camera, T_world_camera, {1, 1, 4, data});
  }
  const auto row = memory.RowOf({40, 0, 10});
  ASSERT_TRUE(row.has_value());
  EXPECT_NEAR(memory.BestViewOf(*row).x(), 3.0, 1e-6);
}

TEST(SemanticMemoryTest, GridWithNanIsLeftOutAndCounted) {
  Rng rng(4);
  TestFrame f = MakeFrame(20, 16, 3, 3, 16, rng);
  f.data[17] = std::numeric_limits<float>::quiet_NaN();
  SemanticMemory memory;
  FuseFrame(memory, f);
  EXPECT_EQ(memory.Size(), 0);
  EXPECT_EQ(memory.Counters().rejected_frames, 1);
}

TEST(SemanticMemoryTest, RowsTakenOutAndPutBackAreTheSame) {
  Rng rng(8);
  SemanticMemory memory;
  const TestFrame f = MakeFrame(40, 30, 6, 8, 100, rng);
  FuseFrame(memory, f);
  SemanticMemory copy;
  for (std::int64_t row = 0; row < memory.Size(); ++row) copy.AppendRow(memory.RowAt(row));
  FuseFrame(memory, f);
  FuseFrame(copy, f);
  ASSERT_EQ(copy.Size(), memory.Size());
  const std::vector<float> text(100, 0.3f);
  EXPECT_EQ(copy.Similarity(text), memory.Similarity(text));
  for (std::int64_t row = 0; row < memory.Size(); ++row) {
    EXPECT_EQ(copy.FeatureAt(row), memory.FeatureAt(row));
    EXPECT_EQ(copy.WeightAt(row), memory.WeightAt(row));
    EXPECT_EQ(copy.BestViewOf(row), memory.BestViewOf(row));
  }
}

TEST(SemanticMemoryTest, LimitedWeightsLetNewViewsOutweighOldViews) {
  SemanticMemory memory({}, 0.1);
  MemoryRow heavy, light;
  heavy.weight = 40;
  light.weight = 0.25F;
  light.key = {1, 0, 0};
  heavy.half = light.half = {0x3c00, 0};
  memory.AppendRow(heavy);
  memory.AppendRow(light);
  memory.LimitWeights(1);
  EXPECT_EQ(memory.WeightAt(0), 1);
  EXPECT_EQ(memory.WeightAt(1), 0.25F);
}

}  // namespace
}  // namespace crossnav::memory
