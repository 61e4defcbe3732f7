// SPDX-License-Identifier: MIT
// A small canvas: lines, discs and letters on an RGB image, in pixels, anti-aliased.
#pragma once

#include <string_view>

#include "crossnav/core/image.h"

namespace crossnav::app {

struct PixelPoint {
  double u = 0, v = 0;
};

class Canvas {
 public:
  explicit Canvas(RgbImage image) : image_(std::move(image)) {}

  void Line(PixelPoint a, PixelPoint b, double width_px, Rgb8 colour);
  void Disc(PixelPoint center, double radius_px, Rgb8 colour);
  void Ring(PixelPoint center, double radius_px, double width_px, Rgb8 colour);
  void Box(PixelPoint a, PixelPoint b, double width_px, Rgb8 colour);
  void Fill(PixelPoint a, PixelPoint b, Rgb8 colour, double opacity);
  /// Capitals, digits and a few signs, 5 x 7 times `scale` pixels a letter; (u, v) is top left.
  void Text(PixelPoint at, std::string_view text, int scale, Rgb8 colour);

  const RgbImage& image() const { return image_; }

 private:
  void Blend(int u, int v, Rgb8 colour, double opacity);
  RgbImage image_;
};

/// Width of a text in pixels.
inline int TextWidth(std::string_view text, int scale) {
  return static_cast<int>(text.size()) * 6 * scale;
}

}  // namespace crossnav::app
