// SPDX-License-Identifier: MIT
#include "crossnav/objects/appearance.h"

#include <gtest/gtest.h>

namespace crossnav::objects {
namespace {

using geometry::VoxelKey;

ColourHistogram Of(const Rgb8& colour, int side_px = 40) {
  ColourHistogram colours;
  colours.Add(RgbImage(side_px, side_px, colour), MaskImage(side_px, side_px, 1),
              {0, 0, side_px, side_px});
  return colours;
}

TEST(ColourHistogram, TheSamePaintInOtherLightIsNearerThanAnotherPaint) {
  const ColourHistogram red = Of({190, 40, 40});
  const auto same = OverlapOf(red, Of({190, 40, 40}, 400));
  const auto darker = OverlapOf(red, Of({170, 36, 36}));
  const auto blue = OverlapOf(red, Of({40, 40, 190}));
  ASSERT_TRUE(same && darker && blue);
  EXPECT_NEAR(*same, 1, 1e-9);
  EXPECT_GT(*darker, 0.8);
  EXPECT_LT(*blue, 0.1);
}

TEST(ColourHistogram, BlackPicturesAndEmptyMasksTellNothing) {
  EXPECT_TRUE(Of({0, 0, 0}).empty());
  ColourHistogram colours;
  colours.Add(RgbImage(8, 8, {9, 9, 9}), MaskImage(8, 8), {0, 0, 8, 8});
  colours.Add(RgbImage(8, 8, {9, 9, 9}), MaskImage(4, 4, 1), {0, 0, 8, 8});
  EXPECT_FALSE(OverlapOf(colours, Of({9, 9, 9})).has_value());
}

TEST(ColourHistogram, APortraitIsReadFromItsMiddle) {
  RgbImage rgb(64, 64, {30, 30, 200});
  for (int v = 10; v < 54; ++v)
    for (int u = 10; u < 54; ++u) rgb.At(u, v) = {190, 40, 40};
  const auto portrait = PictureOf(rgb, {0, 0, 64, 64});
  EXPECT_NEAR(OverlapOf(ColoursOfPortrait(portrait), Of({190, 40, 40})).value_or(0), 1, 1e-6);
  EXPECT_TRUE(ColoursOfPortrait({1, 2, 3}).empty());
}

memory::SemanticMemory RowOf(const std::vector<std::pair<VoxelKey, std::vector<float>>>& voxels) {
  memory::SemanticMemory memory({}, 0.1, 4);
  for (const auto& [key, feature] : voxels) {
    memory::MemoryRow row;
    row.key = key;
    row.weight = 1;
    row.half.resize(4);
    for (std::size_t i = 0; i < 4; ++i) row.half[i] = feature[i] > 0.5F ? 0x3C00 : 0;  // 1 or 0
    memory.AppendRow(row);
  }
  return memory;
}

TEST(Appearance, FeaturesOfAnObjectAndOfItsSurroundingsAreKeptApart) {
  const std::vector<VoxelKey> object = {{0, 0, 0}, {0, 0, 1}};
  const auto memory = RowOf({{{0, 0, 0}, {1, 0, 0, 0}},
                             {{0, 0, 1}, {1, 0, 0, 0}},
                             {{1, 0, 0}, {1, 0, 0, 0}},  // beside it: its own border
                             {{5, 0, 0}, {0, 1, 0, 0}},
                             {{50, 0, 0}, {0, 0, 1, 0}}});
  EXPECT_EQ(FeatureAt(memory, object), (std::vector<float>{1, 0, 0, 0}));
  EXPECT_EQ(FeatureAround(memory, object, 1.0), (std::vector<float>{0, 1, 0, 0}));
  EXPECT_TRUE(FeatureAt(memory, std::vector<VoxelKey>{{9, 9, 9}}).empty());
  EXPECT_TRUE(FeatureAround(memory, {}, 1.0).empty());
}

TEST(Appearance, CommonDirectionsDoNotMakeObjectsAlike) {
  const std::vector<float> a = {1, 0.2F, 0, 0}, b = {1, -0.2F, 0, 0}, c = {1, 0.3F, 0, 0};
  const std::vector<std::vector<float>> common = {{1, 0, 0, 0}};
  EXPECT_GT(OwnCosine(a, b, {}).value_or(-1), 0.9);
  EXPECT_NEAR(OwnCosine(a, b, common).value_or(9), -1, 1e-6);
  EXPECT_NEAR(OwnCosine(a, c, common).value_or(9), 1, 1e-6);
  EXPECT_FALSE(OwnCosine(common[0], a, common).has_value());
  EXPECT_FALSE(OwnCosine({}, a, common).has_value());
}

}  // namespace
}  // namespace crossnav::objects
