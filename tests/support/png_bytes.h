// SPDX-License-Identifier: MIT
// A picture as the bytes of a PNG file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "crossnav/core/png_image.h"

namespace crossnav::test {

inline std::vector<std::uint8_t> PngBytes(const RgbImage& image) {
  const std::string png = EncodePng(image);
  return {png.begin(), png.end()};
}

}  // namespace crossnav::test
