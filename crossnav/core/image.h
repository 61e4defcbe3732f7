// SPDX-License-Identifier: MIT
// A dense row-major image by value. Pixel (u, v) = (column, row), origin top left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crossnav {

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

template <class T>
struct Image {
  int width = 0;        // [px]
  int height = 0;       // [px]
  std::vector<T> data;  // height x width, row-major

  Image() = default;
  Image(int width_px, int height_px, T fill = T{})
      : width(width_px),
        height(height_px),
        data(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), fill) {}

  T& At(int u, int v) { return data[static_cast<std::size_t>(v) * width + u]; }
  const T& At(int u, int v) const { return data[static_cast<std::size_t>(v) * width + u]; }
  bool Contains(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
  bool empty() const { return data.empty(); }
};

using RgbImage = Image<Rgb8>;
using DepthImage = Image<float>;            ///< planar z [m], 0 = invalid
using MaskImage = Image<std::uint8_t>;      ///< 0 or 1
using InstanceImage = Image<std::int32_t>;  ///< instance id, 0 = none

}  // namespace crossnav
