// SPDX-License-Identifier: MIT
#include "crossnav/trace/sight.h"

#include <gtest/gtest.h>

namespace crossnav::trace {
namespace {

Sight Small() {
  Sight sight;
  sight.width_px = 200;
  sight.height_px = 100;
  sight.boxes = {{10, 20, 30, 40, 0.75, 0.9}};
  sight.masks = MaskImage(200, 100, 0);
  for (int u = 0; u < 100; ++u)
    for (int v = 0; v < 100; ++v) sight.masks.At(u, v) = 1;
  sight.stair_probability = Image<float>(200, 100, 0.4F);
  sight.similarity = Image<float>(2, 1, 0.1F);
  sight.similarity.At(1, 0) = 0.9F;
  return sight;
}

TEST(Sight, ANoteReadsBackToItself) {
  const SightNote note = NoteOf(Small());
  EXPECT_FLOAT_EQ(static_cast<float>(note.similarity_min), 0.1F);
  EXPECT_FLOAT_EQ(static_cast<float>(note.similarity_max), 0.9F);
  const std::string json = ToJson(note);
  const auto back = SightNoteFromJson(json);
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_EQ(ToJson(*back), json);
  EXPECT_EQ(back->boxes.size(), 1U);
  EXPECT_EQ(back->boxes[0].v1, 40);
}

TEST(Sight, ADamagedNoteIsAnError) {
  EXPECT_FALSE(SightNoteFromJson("{\"width_px\":"));
  EXPECT_FALSE(SightNoteFromJson("{\"width_px\":\"wide\"}"));
}

TEST(Sight, ThreeImagesShareOnePicture) {
  const RgbImage maps = MapsOf(Small(), 50);
  ASSERT_EQ(maps.width, 50);
  ASSERT_EQ(maps.height, 25);
  EXPECT_EQ(maps.At(10, 10).r, 255);
  EXPECT_EQ(maps.At(40, 10).r, 0);
  EXPECT_EQ(maps.At(10, 10).g, 102);  // 6 of 15 steps
  EXPECT_EQ(maps.At(10, 10).b, 0);
  EXPECT_EQ(maps.At(40, 10).b, 255);
}

TEST(Sight, NothingSeenIsAPictureOfNothing) {
  Sight sight;
  sight.width_px = sight.height_px = 10;
  const RgbImage maps = MapsOf(sight, 96);
  EXPECT_EQ(maps.width, 10);
  EXPECT_EQ(maps.At(5, 5).r + maps.At(5, 5).g + maps.At(5, 5).b, 0);
  EXPECT_TRUE(NoteOf(sight).boxes.empty());
}

}  // namespace
}  // namespace crossnav::trace
