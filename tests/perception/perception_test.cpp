// SPDX-License-Identifier: MIT
#include "crossnav/perception/perception.h"

#include <gtest/gtest.h>

#include <array>

#include "support/fake_perception.h"

namespace crossnav::perception {
namespace {

using test::FakeSight;
using test::FakeSuite;

Observation SmallFrame() {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(8, 6, DegToRad(90));
  obs.rgb = RgbImage(8, 6);
  obs.depth_m = DepthImage(8, 6, 1.0F);
  return obs;
}

Detection DetectionOf(float confidence, int u0) {
  Detection detection;
  detection.box = {u0, 0, u0 + 2, 3};
  detection.confidence = confidence;
  return detection;
}

TEST(Look, SegmentsEveryDetectionAndSortsBestFirst) {
  FakeSight sight;
  sight.detect = [](const Observation&, std::string_view goal) {
    EXPECT_EQ(goal, "sofa");
    return std::vector<Detection>{DetectionOf(0.5F, 0), DetectionOf(0.9F, 2), DetectionOf(0.7F, 4)};
  };
  sight.segment = [](const Observation& obs, Detection& detection) {
    detection.mask = MaskImage(obs.rgb.width, obs.rgb.height, 1);
    detection.mask_quality = detection.confidence / 2;
  };
  auto suite = FakeSuite(sight);
  const auto seen = suite.Look(SmallFrame(), "sofa");
  ASSERT_TRUE(seen.has_value());
  ASSERT_EQ(seen->detections.size(), 3u);
  EXPECT_EQ(seen->detections[0].box.u0, 2);
  EXPECT_EQ(seen->detections[1].box.u0, 4);
  EXPECT_EQ(seen->detections[2].box.u0, 0);
  for (const Detection& detection : seen->detections) {
    EXPECT_EQ(detection.mask.width, 8);
    EXPECT_FLOAT_EQ(detection.mask_quality, detection.confidence / 2);
  }
}

TEST(Look, KeepsTheDetectorsOrderAmongEquals) {
  FakeSight sight;
  sight.detect = [](const Observation&, std::string_view) {
    std::vector<Detection> equals;
    for (int i = 0; i < 6; ++i) equals.push_back(DetectionOf(0.8F, i));
    return equals;
  };
  auto suite = FakeSuite(sight);
  const auto seen = suite.Look(SmallFrame(), "bed");
  ASSERT_TRUE(seen.has_value());
  for (int i = 0; i < 6; ++i) EXPECT_EQ(seen->detections[static_cast<std::size_t>(i)].box.u0, i);
}

TEST(Look, GivesStairProbabilityAndFeaturesOfTheFrame) {
  FakeSight sight;
  sight.stairs = [](const Observation& obs) {
    return Image<float>(obs.rgb.width, obs.rgb.height, 0.25F);
  };
  sight.features = [](const Observation&) { return FeatureGrid{1, 1, 4, {1, 2, 3, 4}}; };
  auto suite = FakeSuite(sight);
  const auto seen = suite.Look(SmallFrame(), "bed");
  ASSERT_TRUE(seen.has_value());
  EXPECT_EQ(seen->stair_probability.data, std::vector<float>(48, 0.25F));
  EXPECT_EQ(seen->features.data, (std::vector<float>{1, 2, 3, 4}));
}

TEST(Look, HandsOnTheErrorOfWhicheverPartFails) {
  for (const std::string part : {"detector", "segmenter", "stairs", "encoder"}) {
    FakeSight sight;
    sight.failing = part;
    sight.detect = [](const Observation&, std::string_view) {
      return std::vector<Detection>{DetectionOf(0.8F, 0)};
    };
    auto suite = FakeSuite(sight);
    const auto seen = suite.Look(SmallFrame(), "bed");
    ASSERT_FALSE(seen.has_value()) << part;
    EXPECT_EQ(seen.error().where, part);
    EXPECT_EQ(seen.error().code, ErrorCode::kMalformed);
  }
}

/// Knows one word.
struct TableEncoder : DenseEncoder {
  ErrorCode otherwise = ErrorCode::kUnsupported;
  int Dim() const override { return 2; }
  std::string Name() const override { return "table"; }
  Result<FeatureGrid> EncodeImage(const Observation&) override { return FeatureGrid{}; }
  Result<std::vector<float>> EncodeText(std::string_view text) override {
    if (text == "wall") return std::vector<float>{1, 0};
    return Fail(otherwise, "has no vector for it");
  }
};

TEST(EncodeTexts, WordsThatATableLacksAreLeftOutAndNoneAtAllIsSaid) {
  TableEncoder encoder;
  const std::array<const char*, 3> texts = {"wall", "furniture", "thing"};
  const auto some = EncodeTexts(encoder, texts);
  ASSERT_TRUE(some.has_value()) << some.error().Message();
  EXPECT_EQ(*some, (std::vector<std::vector<float>>{{1, 0}}));
  const auto none = EncodeTexts(encoder, std::span(texts).subspan(1));
  ASSERT_FALSE(none.has_value());
  for (const char* part : {"\"furniture\", \"thing\"", "query.relevancy"}) {
    EXPECT_NE(none.error().what.find(part), std::string::npos) << none.error().Message();
  }
  encoder.otherwise = ErrorCode::kIo;
  EXPECT_EQ(EncodeTexts(encoder, texts).error().code, ErrorCode::kIo);
}

TEST(PixelBox, AreaCountsItsPixels) {
  EXPECT_EQ((PixelBox{2, 3, 7, 5}.Area()), 10);
  EXPECT_EQ((PixelBox{2, 3, 2, 5}.Area()), 0);
}

}  // namespace
}  // namespace crossnav::perception
