// SPDX-License-Identifier: MIT
#include "crossnav/core/png_image.h"

#include <gtest/gtest.h>

namespace crossnav {
namespace {

std::span<const std::uint8_t> BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(PngImage, ColourAndMaskComeBackAndTheSameImageGivesTheSameBytes) {
  RgbImage rgb(3, 2);
  rgb.At(2, 1) = {9, 8, 7};
  MaskImage opaque(3, 2, 1);
  opaque.At(0, 1) = 0;
  const std::string bytes = EncodePng(rgb, opaque);
  EXPECT_TRUE(IsPng(BytesOf(bytes)));
  EXPECT_EQ(bytes, EncodePng(rgb, opaque));
  const auto back = DecodePng(BytesOf(bytes), "a.png");
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_EQ(back->At(2, 1), (Rgba8{9, 8, 7, 255}));
  EXPECT_EQ(back->At(0, 1), (Rgba8{0, 0, 0, 0}));
  const std::string plain = EncodePng(rgb);
  EXPECT_EQ(DecodePng(BytesOf(plain), "b.png")->At(0, 1), (Rgba8{0, 0, 0, 255}));
}

TEST(PngImage, GreyComesBack) {
  Image<std::uint8_t> grey(2, 2);
  grey.At(1, 0) = 77;
  const auto back = DecodePng(BytesOf(EncodePng(grey)), "g.png");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->At(1, 0), (Rgba8{77, 77, 77, 255}));
}

TEST(PngImage, EveryCutIsAnErrorThatNamesTheFile) {
  const std::string bytes = EncodePng(RgbImage(8, 8, {1, 2, 3}));
  for (std::size_t n = 0; n + 12 < bytes.size(); ++n) {  // the last 12 end the file
    for (const auto& error :
         {DecodePng(BytesOf(bytes.substr(0, n)), "cut.png").map([](auto&&) {}),
          DecodePng16(BytesOf(bytes.substr(0, n)), 8192, "cut.png").map([](auto&&) {})}) {
      ASSERT_FALSE(error) << n;
      EXPECT_EQ(error.error().where, "cut.png");
    }
  }
  EXPECT_EQ(DecodePng16(BytesOf(bytes), 8192, "c.png").error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace crossnav
