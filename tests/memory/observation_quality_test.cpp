// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "crossnav/core/rng.h"
#include "crossnav/memory/observation_quality.h"
#include "crossnav/memory/semantic_memory.h"
#include "memory/golden_file.h"
#include "memory/literal_memory.h"

namespace crossnav::memory {
namespace {

TEST(ObservationQualityTest, EqualsTheGoldenVectors) {
  const auto golden = testing::ReadGolden("quality.json");
  if (!golden) GTEST_SKIP() << "no golden vectors beside the project";
  const DepthImage depth = testing::DepthOf((*golden)["depth"]);
  for (const auto& test : (*golden)["cases"]) {
    FusionConfig config;
    config.gamma = test["gamma"];
    config.preferred_depth_m = test["d0"];
    config.depth_scale_m = test["sigma"];
    config.gradient_scale = test["gradient_scale"];
    const Image<float> q = ObservationQuality(depth, {}, config);
    for (int v = 0; v < depth.height; ++v)
      for (int u = 0; u < depth.width; ++u)
        EXPECT_NEAR(q.At(u, v), test["q"][v][u].get<double>(), 1e-5) << u << "," << v;
  }
}

TEST(ObservationQualityTest, IsZeroExactlyWhereDepthIsInvalid) {
  Rng rng(3);
  DepthImage depth(37, 11);
  for (float& d : depth.data) d = static_cast<float>(rng.Uniform(0.2, 9.0));
  depth.At(0, 0) = 0;
  depth.At(36, 10) = std::numeric_limits<float>::quiet_NaN();
  depth.At(5, 5) = std::numeric_limits<float>::infinity();
  depth.At(6, 5) = -1;
  const Image<float> q = ObservationQuality(depth, IntrinsicsFromHfov(37, 11, 1.5), {});
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u) {
      const bool is_valid = testing::IsValidDepth(depth.At(u, v));
      EXPECT_EQ(q.At(u, v) > 0, is_valid) << u << "," << v;
    }
}

TEST(ObservationQualityTest, RowsInAnyOrderEqualTheWholeImage) {
  Rng rng(4);
  const CameraIntrinsics camera = IntrinsicsFromHfov(37, 11, 1.5);
  QualityRows rows;
  for (int frame = 0; frame < 3; ++frame) {
    DepthImage depth(37, 11);
    for (float& d : depth.data)
      d = rng.Chance(0.2) ? 0.0F : static_cast<float>(rng.Uniform(0.2, 9.0));
    const Image<float> q = ObservationQuality(depth, camera, {});
    rows.Reset(depth, camera, {});
    for (const int v : {0, 1, 4, 5, 6, 10, 9, 9, 0, 10}) {
      const float* row = rows.Row(v);
      for (int u = 0; u < depth.width; ++u) ASSERT_EQ(row[u], q.At(u, v)) << u << "," << v;
    }
  }
}

TEST(ObservationQualityTest, KeepsRelativePrecisionWhereTheWeightIsTiny) {
  DepthImage depth(64, 3);
  for (int v = 0; v < 3; ++v)
    for (int u = 0; u < 64; ++u) depth.At(u, v) = u % 2 ? 0.5f + 0.1f * u : 7.0f;
  FusionConfig config;
  config.gradient_scale = 2;
  const Image<float> q = ObservationQuality(depth, {}, config);
  testing::LiteralFactors factors;
  factors.gradient_scale = 2;
  for (int u = 0; u < 64; ++u) {
    const double expected = testing::LiteralQuality(depth, u, 1, factors);
    EXPECT_NEAR(q.At(u, 1) / expected, 1.0, 1e-5) << u;
  }
}

TEST(ObservationQualityTest, IsWithinAFewRoundingsOfTheFormula) {
  Rng rng(7);
  const float invalid[] = {0, -1, std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN()};
  FusionConfig config;
  config.gradient_scale = 2;
  testing::LiteralFactors factors;
  factors.gradient_scale = 2;
  double largest = 0;
  for (const double slope : {0.0, 0.001, 0.1, 1.0, 5.0}) {
    DepthImage depth(67, 5);
    for (int i = 0; i < 300; ++i) {
      const double base_m = rng.Uniform(0.2, 6.0);
      for (float& d : depth.data)
        d = rng.Chance(0.1) ? invalid[rng.Int(0, 3)]
                            : static_cast<float>(base_m + slope * rng.Uniform(0, 1));
      const Image<float> q = ObservationQuality(depth, {}, config);
      for (int v = 0; v < depth.height; ++v)
        for (int u = 0; u < depth.width; ++u) {
          const double expected = testing::LiteralQuality(depth, u, v, factors);
          if (expected == 0) {
            ASSERT_EQ(q.At(u, v), 0) << u << "," << v;
          } else {  // the exponent is rounded
            const double roundings = 1 - std::log2(expected);
            largest = std::max(largest, std::abs(q.At(u, v) / expected - 1) / roundings);
          }
        }
    }
  }
  EXPECT_LT(largest, 4e-7);
}

TEST(ObservationQualityTest, DefaultGradientScaleIsWidthOverFocalLengthAtThePapersWidth) {
  for (const int width_px : {64, 640}) {
    DepthImage depth(width_px, 4);
    for (int v = 0; v < 4; ++v)
      for (int u = 0; u < width_px; ++u) depth.At(u, v) = 2.0f + 0.1f * static_cast<float>(u);
    const CameraIntrinsics camera = IntrinsicsFromHfov(width_px, 4, 1.2);
    FusionConfig explicit_scale;
    explicit_scale.gradient_scale = width_px / 640.0 * width_px / camera.fx;
    EXPECT_EQ(ObservationQuality(depth, camera, {}).data,
              ObservationQuality(depth, camera, explicit_scale).data);
  }
}

// Depth of the wall z = 2 m + slope x, seen by a camera with 90 degrees across.
DepthImage SlantedWall(const CameraIntrinsics& camera, double slope) {
  DepthImage depth(camera.width_px, camera.height_px);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u)
      depth.At(u, v) = static_cast<float>(2 / (1 - slope * (u - camera.cx) / camera.fx));
  return depth;
}

double WeightAt(double across, int width_px, double slope) {
  const CameraIntrinsics camera = IntrinsicsFromHfov(width_px, 5, std::numbers::pi / 2);
  const auto q = ObservationQuality(SlantedWall(camera, slope), camera, {});
  return q.At(static_cast<int>(across * width_px), 2);
}

TEST(ObservationQualityTest, DoesNotDependOnTheResolution) {
  for (const double slope : {0.2, 0.5, 0.8}) {
    for (const double across : {0.1, 0.25, 0.5, 0.75, 0.9}) {
      const double at_640 = WeightAt(across, 640, slope);
      EXPECT_GT(at_640, 0);
      for (const int width_px : {320, 1280})
        EXPECT_NEAR(WeightAt(across, width_px, slope) / at_640, 1, 0.05)
            << slope << ", " << across << ", " << width_px;
    }
  }
}

}  // namespace
}  // namespace crossnav::memory
