// SPDX-License-Identifier: MIT
#include "crossnav/perception/goal_picture.h"

#include <gtest/gtest.h>

#include "crossnav/core/png_image.h"
#include "support/fake_perception.h"

namespace crossnav::perception {
namespace {

using test::FakeSight;
using test::FakeSuite;

/// Grey, with a red square in the middle.
GoalPicture RedInTheMiddle(int side_px = 64) {
  GoalPicture picture;
  picture.rgb = RgbImage(side_px, side_px, {120, 120, 120});
  for (int v = side_px / 4; v < side_px * 3 / 4; ++v)
    for (int u = side_px / 4; u < side_px * 3 / 4; ++u) picture.rgb.At(u, v) = {200, 20, 20};
  return picture;
}

Result<GoalPicture> Decoded(const std::string& png,
                            const std::optional<PixelBox>& box = std::nullopt) {
  return DecodeGoalPicture({reinterpret_cast<const std::uint8_t*>(png.data()), png.size()}, box,
                           "p.png");
}

/// Red cells are (1, 0, 0, 0), others (0, 1, 0, 0).
FeatureGrid GridOf(const Observation& obs) {
  FeatureGrid grid{8, 8, 4, {}};
  for (int row = 0; row < 8; ++row)
    for (int col = 0; col < 8; ++col) {
      const Rgb8& pixel = obs.rgb.At(col * obs.rgb.width / 8, row * obs.rgb.height / 8);
      const bool is_red = pixel.g < 50;
      for (const float x : {is_red ? 1.0F : 0.0F, is_red ? 0.0F : 1.0F, 0.0F, 0.0F})
        grid.data.push_back(x);
    }
  return grid;
}

TEST(GoalPicture, APngBecomesAPictureAndTheNameFollowsItsContent) {
  const GoalPicture picture = RedInTheMiddle();
  const auto read = Decoded(EncodePng(picture.rgb));
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(read->rgb.data, picture.rgb.data);
  const std::string name = NameOfPicture(picture);
  EXPECT_EQ(NameOfPicture(*read), name);
  EXPECT_TRUE(IsPictureName(name));
  GoalPicture changed = picture;
  changed.rgb.At(0, 0).b = 9;
  EXPECT_NE(NameOfPicture(changed), name);
  changed = picture;
  changed.box = PixelBox{16, 16, 48, 48};
  EXPECT_NE(NameOfPicture(changed), name);
}

TEST(GoalPicture, OtherTextsAreNoNamesOfPictures) {
  for (const char* text : {"picture", "picture 12", "a picture 0123456789abcdef", "",
                           "picture 0123456789abcdeg", "picture 0123456789abcdef0"})
    EXPECT_FALSE(IsPictureName(text)) << text;
}

TEST(GoalPicture, DamagedAndOversizedPicturesAreRefused) {
  std::string png = EncodePng(RedInTheMiddle().rgb);
  EXPECT_FALSE(Decoded(""));
  EXPECT_FALSE(Decoded("no picture at all"));
  EXPECT_FALSE(Decoded(png.substr(0, png.size() / 2)));
  EXPECT_FALSE(Decoded(EncodePng(RgbImage(8, 8))));
  EXPECT_FALSE(Decoded(EncodePng(RgbImage(kMostPictureSide_px + 1, 40))));
  EXPECT_FALSE(Decoded(png, PixelBox{0, 0, 65, 10}));
  EXPECT_FALSE(Decoded(png, PixelBox{10, 10, 10, 20}));
  EXPECT_FALSE(Decoded(png, PixelBox{-1, 0, 5, 5}));
  EXPECT_TRUE(Decoded(png, PixelBox{0, 0, 64, 10}));
}

TEST(GoalPicture, FeaturesArePooledOverTheMaskOrOverTheRest) {
  Observation obs;
  obs.rgb = RedInTheMiddle().rgb;
  MaskImage mask(64, 64);
  for (std::size_t i = 0; i < mask.data.size(); ++i) mask.data[i] = obs.rgb.data[i].g < 50 ? 1 : 0;
  const FeatureGrid grid = GridOf(obs);
  EXPECT_FLOAT_EQ(PooledFeature(grid, mask).at(0), 1);
  EXPECT_FLOAT_EQ(PooledFeature(grid, mask, true).at(1), 1);
  EXPECT_TRUE(PooledFeature(grid, MaskImage(64, 64)).empty());
}

/// A chair in the middle, and a bed, more confident, in a corner.
FakeSight ChairAndBed() {
  FakeSight sight;
  sight.detect = [](const Observation&, std::string_view goal) -> std::vector<Detection> {
    if (goal == "chair") return {{{16, 16, 48, 48}, 0.6F, {}, 0}};
    if (goal == "bed") return {{{0, 0, 12, 12}, 0.9F, {}, 0}};
    return {};
  };
  sight.segment = [](const Observation& obs, Detection& detection) {
    detection.mask = MaskImage(obs.rgb.width, obs.rgb.height);
    for (int v = 20; v < 40; ++v)
      for (int u = 20; u < 40; ++u) detection.mask.At(u, v) = 1;
  };
  sight.features = GridOf;
  return sight;
}

TEST(ReadPicture, TheObjectInTheMiddleOrInTheBoxIsMeant) {
  const auto suite = FakeSuite(ChairAndBed());
  const std::vector<std::string> names = {"bed", "chair"};
  GoalPicture picture = RedInTheMiddle();
  auto reading = ReadPicture(suite, picture, names);
  ASSERT_TRUE(reading) << reading.error().Message();
  EXPECT_EQ(reading->category, "chair");
  EXPECT_EQ(std::count(reading->mask.data.begin(), reading->mask.data.end(), 1), 400);
  picture.box = PixelBox{0, 0, 14, 14};
  reading = ReadPicture(suite, picture, names);
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->category, "bed");
}

TEST(ReadPicture, WithoutADetectionTheNearestNameIsTheCategory) {
  FakeSight sight;
  sight.features = GridOf;
  sight.text = [](std::string_view text) {
    return text == "sofa" ? std::vector<float>{1, 0, 0, 0} : std::vector<float>{0, 1, 0, 0};
  };
  const std::vector<std::string> names = {"bed", "sofa", "chair"};
  const auto reading = ReadPicture(FakeSuite(sight), RedInTheMiddle(), names);
  ASSERT_TRUE(reading) << reading.error().Message();
  EXPECT_EQ(reading->category, "sofa");
  EXPECT_EQ(reading->mask.At(32, 32), 1);
  EXPECT_EQ(reading->mask.At(2, 2), 0);
}

TEST(ReadPicture, FailuresOfNetworksAreReported) {
  for (const char* part : {"detector", "encoder"}) {
    FakeSight sight = ChairAndBed();
    sight.failing = part;
    const std::vector<std::string> names = {"chair"};
    EXPECT_FALSE(ReadPicture(FakeSuite(sight), RedInTheMiddle(), names)) << part;
  }
  EXPECT_FALSE(ReadPicture(FakeSuite(ChairAndBed()), GoalPicture{}, {}));
}

}  // namespace
}  // namespace crossnav::perception
