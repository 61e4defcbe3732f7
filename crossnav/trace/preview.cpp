// SPDX-License-Identifier: MIT
#include "crossnav/trace/preview.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

#include "crossnav/core/check.h"
#include "crossnav/core/png_image.h"

namespace crossnav::trace {
namespace {

Rgb8 MeanOfBlock(const RgbImage& rgb, int u0, int v0, int factor) {
  int sum[3] = {0, 0, 0};
  for (int v = v0; v < v0 + factor; ++v) {
    for (int u = u0; u < u0 + factor; ++u) {
      const Rgb8& pixel = rgb.At(u, v);
      sum[0] += pixel.r;
      sum[1] += pixel.g;
      sum[2] += pixel.b;
    }
  }
  const int n = factor * factor;
  const auto mean = [n](int s) { return static_cast<std::uint8_t>((s + n / 2) / n); };
  return {mean(sum[0]), mean(sum[1]), mean(sum[2])};
}

std::uint16_t ToMm(float depth_m) {
  if (!(depth_m > 0) || depth_m > 65.535F) return 0;
  return static_cast<std::uint16_t>(std::lround(static_cast<double>(depth_m) * 1000));
}

std::uint8_t ToGrey(std::uint16_t depth_mm, double max_m) {
  if (depth_mm == 0) return 0;
  return static_cast<std::uint8_t>(1 + std::lround(254 * std::min(depth_mm / 1000.0 / max_m, 1.0)));
}

}  // namespace

int ShrinkFactor(int size_px, int max_px) {
  const int most_px = std::max(1, max_px);
  return std::max(1, (size_px + most_px - 1) / most_px);
}

RgbImage Shrink(const RgbImage& rgb, int factor) {
  if (factor <= 1) return rgb;
  RgbImage small(rgb.width / factor, rgb.height / factor);
  for (int v = 0; v < small.height; ++v) {
    for (int u = 0; u < small.width; ++u) {
      small.At(u, v) = MeanOfBlock(rgb, u * factor, v * factor, factor);
    }
  }
  return small;
}

Image<std::uint16_t> ShrinkDepthMm(const DepthImage& depth_m, int factor) {
  Image<std::uint16_t> small(depth_m.width / factor, depth_m.height / factor);
  for (int v = 0; v < small.height; ++v) {
    for (int u = 0; u < small.width; ++u) {
      small.At(u, v) = ToMm(depth_m.At(u * factor + factor / 2, v * factor + factor / 2));
    }
  }
  return small;
}

std::string EncodeJpeg(const RgbImage& rgb, int quality) {
  CROSSNAV_CHECK(!rgb.empty(), "an empty image has no JPEG");
  jpeg_error_mgr errors;
  jpeg_compress_struct jpeg;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): libjpeg's type
  jpeg_mem_dest(&jpeg, &buffer, &size);
  jpeg.image_width = static_cast<JDIMENSION>(rgb.width);
  jpeg.image_height = static_cast<JDIMENSION>(rgb.height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg.dct_method = JDCT_ISLOW;  // the same bits with and without SIMD
  jpeg.optimize_coding = TRUE;
  jpeg_start_compress(&jpeg, TRUE);
  static_assert(sizeof(Rgb8) == 3);
  for (int v = 0; v < rgb.height; ++v) {
    auto* row = reinterpret_cast<JSAMPROW>(const_cast<Rgb8*>(&rgb.At(0, v)));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string bytes(reinterpret_cast<char*>(buffer), size);
  jpeg_destroy_compress(&jpeg);
  std::free(buffer);  // NOLINT(cppcoreguidelines-no-malloc): libjpeg allocated it
  return bytes;
}

std::string EncodeDepthPng(const Image<std::uint16_t>& depth_mm, double max_m) {
  Image<std::uint8_t> grey(depth_mm.width, depth_mm.height);
  std::transform(depth_mm.data.begin(), depth_mm.data.end(), grey.data.begin(),
                 [max_m](std::uint16_t mm) { return ToGrey(mm, max_m); });
  return EncodePng(grey);
}

}  // namespace crossnav::trace
