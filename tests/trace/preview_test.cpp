// SPDX-License-Identifier: MIT
#include "crossnav/trace/preview.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <limits>

#include <jpeglib.h>

namespace crossnav::trace {
namespace {

RgbImage DecodeJpeg(const std::string& bytes) {
  jpeg_error_mgr errors;
  jpeg_decompress_struct jpeg;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  jpeg_start_decompress(&jpeg);
  RgbImage rgb(static_cast<int>(jpeg.output_width), static_cast<int>(jpeg.output_height));
  for (int v = 0; v < rgb.height; ++v) {
    auto* row = reinterpret_cast<JSAMPROW>(&rgb.At(0, v));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_destroy_decompress(&jpeg);
  return rgb;
}

Image<std::uint8_t> DecodeGreyPng(const std::string& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png_image_begin_read_from_memory(&png, bytes.data(), bytes.size());
  png.format = PNG_FORMAT_GRAY;
  Image<std::uint8_t> grey(static_cast<int>(png.width), static_cast<int>(png.height));
  png_image_finish_read(&png, nullptr, grey.data.data(), 0, nullptr);
  return grey;
}

TEST(Preview, ShrinksByTheSmallestWholeFactor) {
  EXPECT_EQ(ShrinkFactor(640, 320), 2);
  EXPECT_EQ(ShrinkFactor(641, 320), 3);
  EXPECT_EQ(ShrinkFactor(320, 320), 1);
  EXPECT_EQ(ShrinkFactor(10, 320), 1);
  EXPECT_EQ(ShrinkFactor(640, 0), 640);
}

TEST(Preview, AveragesColourOverBlocks) {
  RgbImage rgb(5, 2);
  rgb.At(0, 0) = {0, 10, 255};
  rgb.At(1, 0) = {0, 20, 255};
  rgb.At(0, 1) = {0, 30, 255};
  rgb.At(1, 1) = {2, 40, 255};
  const RgbImage small = Shrink(rgb, 2);
  EXPECT_EQ(small.width, 2);  // the fifth column is dropped
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.At(0, 0), (Rgb8{1, 25, 255}));
}

TEST(Preview, NeverMixesDepths) {
  DepthImage depth(4, 4, 1.0F);
  for (int v = 0; v < 4; ++v) depth.At(3, v) = 5.0F;
  const auto small = ShrinkDepthMm(depth, 2);
  EXPECT_EQ(small.At(0, 0), 1000);
  EXPECT_EQ(small.At(1, 1), 5000);
}

TEST(Preview, MakesBadDepthZero) {
  DepthImage depth(5, 1);
  depth.data = {0, -1, std::numeric_limits<float>::quiet_NaN(),
                std::numeric_limits<float>::infinity(), 70};
  for (const auto mm : ShrinkDepthMm(depth, 1).data) EXPECT_EQ(mm, 0);
  depth.data = {0.0004F, 0.001F, 1.2344F, 65.535F, 65.536F};
  EXPECT_EQ(ShrinkDepthMm(depth, 1).data, (std::vector<std::uint16_t>{0, 1, 1234, 65535, 0}));
}

TEST(Preview, JpegLooksLikeTheImage) {
  RgbImage rgb(64, 48);
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      rgb.At(u, v) = {static_cast<std::uint8_t>(4 * u), static_cast<std::uint8_t>(5 * v), 90};
    }
  }
  const std::string bytes = EncodeJpeg(rgb, 85);
  EXPECT_EQ(EncodeJpeg(rgb, 85), bytes);
  const RgbImage back = DecodeJpeg(bytes);
  ASSERT_EQ(back.width, 64);
  ASSERT_EQ(back.height, 48);
  double error = 0;
  for (std::size_t i = 0; i < rgb.data.size(); ++i) {
    error += std::abs(rgb.data[i].r - back.data[i].r) + std::abs(rgb.data[i].g - back.data[i].g);
  }
  EXPECT_LT(error / (2.0 * static_cast<double>(rgb.data.size())), 3.0);
}

TEST(Preview, DepthPngKeepsInvalidApart) {
  Image<std::uint16_t> depth(5, 1);
  depth.data = {0, 1, 5000, 10000, 60000};
  const auto grey = DecodeGreyPng(EncodeDepthPng(depth, 10));
  EXPECT_EQ(grey.data, (std::vector<std::uint8_t>{0, 1, 128, 255, 255}));
}

}  // namespace
}  // namespace crossnav::trace
