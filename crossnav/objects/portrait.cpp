// SPDX-License-Identifier: MIT
#include "crossnav/objects/portrait.h"

#include <algorithm>
#include <string>

#include "crossnav/core/png_image.h"

namespace crossnav::objects {
namespace {

PictureBox Clipped(const RgbImage& rgb, const PictureBox& box) {
  return {std::clamp(box.u0, 0, rgb.width), std::clamp(box.v0, 0, rgb.height),
          std::clamp(box.u1, 0, rgb.width), std::clamp(box.v1, 0, rgb.height)};
}

/// Sums of pixels.
struct Sums {
  std::int64_t r = 0, g = 0, b = 0, count = 0;
  void Add(const Rgb8& p) { r += p.r, g += p.g, b += p.b, ++count; }
  Rgb8 Mean() const {
    const auto mean = [&](std::int64_t sum) {
      return static_cast<std::uint8_t>((sum + count / 2) / count);
    };
    return {mean(r), mean(g), mean(b)};
  }
};

Rgb8 MeanOf(const RgbImage& rgb, const PictureBox& area) {
  Sums sums;
  for (int v = area.v0; v < area.v1; ++v)
    for (int u = area.u0; u < area.u1; ++u) sums.Add(rgb.At(u, v));
  return sums.Mean();
}

}  // namespace

std::optional<std::array<std::uint8_t, 3>> MeanColour(const RgbImage& rgb, const MaskImage& mask,
                                                      const PictureBox& box) {
  if (rgb.width != mask.width || rgb.height != mask.height) return std::nullopt;
  const PictureBox in = Clipped(rgb, box);
  Sums sums;
  for (int v = in.v0; v < in.v1; ++v)
    for (int u = in.u0; u < in.u1; ++u)
      if (mask.At(u, v)) sums.Add(rgb.At(u, v));
  if (sums.count == 0 || sums.r + sums.g + sums.b == 0) return std::nullopt;
  const Rgb8 mean = sums.Mean();
  return std::array<std::uint8_t, 3>{mean.r, mean.g, mean.b};
}

std::vector<std::uint8_t> PictureOf(const RgbImage& rgb, const PictureBox& box) {
  const int margin = std::max(box.u1 - box.u0, box.v1 - box.v0) / 10;
  const PictureBox in =
      Clipped(rgb, {box.u0 - margin, box.v0 - margin, box.u1 + margin, box.v1 + margin});
  const int width = in.u1 - in.u0, height = in.v1 - in.v0;
  if (width <= 0 || height <= 0) return {};
  const int longer = std::max(width, height), side = std::min(longer, kPictureSide_px);
  RgbImage small(std::max(1, width * side / longer), std::max(1, height * side / longer));
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      small.At(x, y) = MeanOf(
          rgb, {in.u0 + x * width / small.width, in.v0 + y * height / small.height,
                in.u0 + (x + 1) * width / small.width, in.v0 + (y + 1) * height / small.height});
  const std::string png = EncodePng(small);
  return {png.begin(), png.end()};
}

}  // namespace crossnav::objects
