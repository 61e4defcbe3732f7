// SPDX-License-Identifier: MIT
#include "canvas.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace crossnav::app {
namespace {

/// Seven rows of five bits, the highest bit on the left.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 7> rows;
};

constexpr std::array<Glyph, 44> kGlyphs = {{
    {'A', {14, 17, 17, 31, 17, 17, 17}}, {'B', {30, 17, 17, 30, 17, 17, 30}},
    {'C', {14, 17, 16, 16, 16, 17, 14}}, {'D', {30, 17, 17, 17, 17, 17, 30}},
    {'E', {31, 16, 16, 30, 16, 16, 31}}, {'F', {31, 16, 16, 30, 16, 16, 16}},
    {'G', {14, 17, 16, 23, 17, 17, 15}}, {'H', {17, 17, 17, 31, 17, 17, 17}},
    {'I', {14, 4, 4, 4, 4, 4, 14}},      {'J', {7, 2, 2, 2, 2, 18, 12}},
    {'K', {17, 18, 20, 24, 20, 18, 17}}, {'L', {16, 16, 16, 16, 16, 16, 31}},
    {'M', {17, 27, 21, 21, 17, 17, 17}}, {'N', {17, 25, 21, 19, 17, 17, 17}},
    {'O', {14, 17, 17, 17, 17, 17, 14}}, {'P', {30, 17, 17, 30, 16, 16, 16}},
    {'Q', {14, 17, 17, 17, 21, 18, 13}}, {'R', {30, 17, 17, 30, 20, 18, 17}},
    {'S', {15, 16, 16, 14, 1, 1, 30}},   {'T', {31, 4, 4, 4, 4, 4, 4}},
    {'U', {17, 17, 17, 17, 17, 17, 14}}, {'V', {17, 17, 17, 17, 17, 10, 4}},
    {'W', {17, 17, 17, 21, 21, 27, 17}}, {'X', {17, 17, 10, 4, 10, 17, 17}},
    {'Y', {17, 17, 10, 4, 4, 4, 4}},     {'Z', {31, 1, 2, 4, 8, 16, 31}},
    {'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
    {'2', {14, 17, 1, 6, 8, 16, 31}},    {'3', {30, 1, 1, 14, 1, 1, 30}},
    {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
    {'6', {14, 16, 30, 17, 17, 17, 14}}, {'7', {31, 1, 2, 4, 8, 8, 8}},
    {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 1, 14}},
    {'.', {0, 0, 0, 0, 0, 12, 12}},      {',', {0, 0, 0, 0, 12, 4, 8}},
    {':', {0, 12, 12, 0, 12, 12, 0}},    {'-', {0, 0, 0, 31, 0, 0, 0}},
    {'_', {0, 0, 0, 0, 0, 0, 31}},       {'/', {1, 1, 2, 4, 8, 16, 16}},
    {'(', {2, 4, 8, 8, 8, 4, 2}},        {')', {8, 4, 2, 2, 2, 4, 8}},
}};

const Glyph* FindGlyph(char letter) {
  const char capital = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  const auto glyph = std::find_if(kGlyphs.begin(), kGlyphs.end(),
                                  [&](const Glyph& g) { return g.letter == capital; });
  return glyph == kGlyphs.end() ? nullptr : &*glyph;
}

std::uint8_t Mix(std::uint8_t below, std::uint8_t above, double opacity) {
  return static_cast<std::uint8_t>(std::lround(below + (above - below) * opacity));
}

/// Share of a pixel whose centre is `distance_px` inside (> 0) or outside of an edge.
double Coverage(double distance_px) {
  return std::clamp(distance_px + 0.5, 0.0, 1.0);
}

double DistanceToSegment(PixelPoint p, PixelPoint a, PixelPoint b) {
  const double du = b.u - a.u, dv = b.v - a.v;
  const double squared = du * du + dv * dv;
  double t = squared > 0 ? ((p.u - a.u) * du + (p.v - a.v) * dv) / squared : 0;
  t = std::clamp(t, 0.0, 1.0);
  return std::hypot(p.u - a.u - t * du, p.v - a.v - t * dv);
}

int Floor(double value) {
  return static_cast<int>(std::floor(value));
}

}  // namespace

void Canvas::Blend(int u, int v, Rgb8 colour, double opacity) {
  if (opacity <= 0 || !image_.Contains(u, v)) return;
  Rgb8& pixel = image_.At(u, v);
  pixel = {Mix(pixel.r, colour.r, opacity), Mix(pixel.g, colour.g, opacity),
           Mix(pixel.b, colour.b, opacity)};
}

void Canvas::Line(PixelPoint a, PixelPoint b, double width_px, Rgb8 colour) {
  const double half = width_px / 2;
  const int u0 = Floor(std::min(a.u, b.u) - half - 1), u1 = Floor(std::max(a.u, b.u) + half + 2);
  const int v0 = Floor(std::min(a.v, b.v) - half - 1), v1 = Floor(std::max(a.v, b.v) + half + 2);
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      const PixelPoint p{static_cast<double>(u), static_cast<double>(v)};
      Blend(u, v, colour, Coverage(half - DistanceToSegment(p, a, b)));
    }
  }
}

void Canvas::Disc(PixelPoint center, double radius_px, Rgb8 colour) {
  Line(center, center, 2 * radius_px, colour);
}

void Canvas::Ring(PixelPoint center, double radius_px, double width_px, Rgb8 colour) {
  const double reach = radius_px + width_px;
  for (int v = Floor(center.v - reach); v <= Floor(center.v + reach + 1); ++v) {
    for (int u = Floor(center.u - reach); u <= Floor(center.u + reach + 1); ++u) {
      const double off = std::abs(std::hypot(u - center.u, v - center.v) - radius_px);
      Blend(u, v, colour, Coverage(width_px / 2 - off));
    }
  }
}

void Canvas::Box(PixelPoint a, PixelPoint b, double width_px, Rgb8 colour) {
  Line(a, {b.u, a.v}, width_px, colour);
  Line({b.u, a.v}, b, width_px, colour);
  Line(b, {a.u, b.v}, width_px, colour);
  Line({a.u, b.v}, a, width_px, colour);
}

void Canvas::Fill(PixelPoint a, PixelPoint b, Rgb8 colour, double opacity) {
  for (int v = Floor(std::min(a.v, b.v) + 0.5); v < Floor(std::max(a.v, b.v) + 0.5); ++v) {
    for (int u = Floor(std::min(a.u, b.u) + 0.5); u < Floor(std::max(a.u, b.u) + 0.5); ++u) {
      Blend(u, v, colour, opacity);
    }
  }
}

void Canvas::Text(PixelPoint at, std::string_view text, int scale, Rgb8 colour) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const Glyph* glyph = FindGlyph(text[i]);
    if (glyph == nullptr) continue;
    for (int row = 0; row < 7; ++row) {
      for (int column = 0; column < 5; ++column) {
        if ((glyph->rows[static_cast<std::size_t>(row)] >> (4 - column) & 1) == 0) continue;
        const double u = at.u + static_cast<double>(i) * 6 * scale + column * scale;
        const double v = at.v + row * scale;
        Fill({u, v}, {u + scale, v + scale}, colour, 1);
      }
    }
  }
}

}  // namespace crossnav::app
