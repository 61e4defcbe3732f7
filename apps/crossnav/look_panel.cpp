// SPDX-License-Identifier: MIT
#include "look_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "canvas.h"
#include "crossnav/core/categories.h"
#include "crossnav/sim/sensing/picture.h"

namespace crossnav::app {
namespace {

constexpr int kMost_px = 640;  // chosen: of a field's longer side
constexpr Rgb8 kLookInk{255, 255, 255}, kStairInk{255, 160, 0};
constexpr std::array<Rgb8, 6> kGoalInk = {Rgb8{255, 80, 80},   Rgb8{80, 160, 255},
                                          Rgb8{80, 220, 80},   Rgb8{240, 240, 80},
                                          Rgb8{220, 100, 255}, Rgb8{80, 230, 230}};

Rgb8 InkOf(const std::string& goal) {
  const auto it = std::find(kCategories.begin(), kCategories.end(), goal);
  return it == kCategories.end() ? kLookInk
                                 : kGoalInk[static_cast<std::size_t>(it - kCategories.begin())];
}

Rgb8 Mix(Rgb8 a, Rgb8 b, double t) {
  const auto mix = [t](int x, int y) { return static_cast<std::uint8_t>(x + t * (y - x)); };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

/// Dark blue over green to yellow for 0 to 1.
Rgb8 Heat(double t) {
  const Rgb8 low{30, 20, 90}, middle{30, 150, 110}, high{255, 235, 60};
  return t < 0.5 ? Mix(low, middle, 2 * t) : Mix(middle, high, 2 * t - 1);
}

std::string SpacedCapitals(std::string text) {
  for (char& c : text)
    c = c == '_' ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// A field of the panel: each pixel by `paint(u, v)` of the frame.
template <class Paint>
Canvas Field(const RgbImage& rgb, double scale, const Paint& paint) {
  RgbImage image(std::max(1, static_cast<int>(rgb.width * scale)),
                 std::max(1, static_cast<int>(rgb.height * scale)));
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
      image.At(u, v) = paint(std::min(static_cast<int>(u / scale), rgb.width - 1),
                             std::min(static_cast<int>(v / scale), rgb.height - 1));
  return Canvas(std::move(image));
}

Canvas Objects(const Observation& obs, const Look& look, double scale) {
  Canvas canvas = Field(obs.rgb, scale, [&](int u, int v) {
    Rgb8 colour = obs.rgb.At(u, v);
    for (const auto& [goal, detection] : look.found)
      if (!detection.mask.empty() && detection.mask.At(u, v) != 0)
        colour = Mix(colour, InkOf(goal), 0.45);
    return colour;
  });
  for (const auto& [goal, detection] : look.found) {
    const auto& box = detection.box;
    canvas.Box({box.u0 * scale, box.v0 * scale}, {box.u1 * scale, box.v1 * scale}, 2, InkOf(goal));
    canvas.Text({box.u0 * scale + 4, box.v0 * scale + 4},
                fmt::format("{} {:.2f}", SpacedCapitals(goal), detection.confidence), 1, kLookInk);
  }
  return canvas;
}

Canvas Similarity(const RgbImage& rgb, const Look& look, double scale) {
  const Image<float>& map = look.similarity;
  const float low = *std::min_element(map.data.begin(), map.data.end());
  const float high = *std::max_element(map.data.begin(), map.data.end());
  const double span = std::max(1e-6F, high - low);
  Canvas canvas = Field(rgb, scale, [&](int u, int v) {
    const float x = map.At(u * map.width / rgb.width, v * map.height / rgb.height);
    return Mix(rgb.At(u, v), Heat((x - low) / span), 0.7);
  });
  canvas.Text({6, 6}, fmt::format("{} {:.2f} TO {:.2f}", SpacedCapitals(look.text), low, high), 1,
              kLookInk);
  return canvas;
}

void Place(const Canvas& field, int left, int top, RgbImage& panel) {
  const RgbImage& image = field.image();
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) panel.At(left + u, top + v) = image.At(u, v);
}

}  // namespace

RgbImage LookPanel(const Observation& obs, const Look& look) {
  const RgbImage& rgb = obs.rgb;
  const double scale =
      std::min(1.0, static_cast<double>(kMost_px) / std::max(rgb.width, rgb.height));
  const Canvas objects = Objects(obs, look, scale);
  const int width = objects.image().width, height = objects.image().height;
  RgbImage panel(2 * width, 2 * height, Rgb8{16, 16, 20});
  Place(objects, 0, 0, panel);
  if (!look.stairs.empty())
    Place(Field(rgb, scale,
                [&](int u, int v) {
                  return Mix(rgb.At(u, v), kStairInk, 0.8 * look.stairs.At(u, v));
                }),
          width, 0, panel);
  const RgbImage depth = sim::ColourDepth(obs.depth_m);
  Place(Field(rgb, scale, [&](int u, int v) { return depth.At(u, v); }), 0, height, panel);
  if (!look.similarity.empty()) Place(Similarity(rgb, look, scale), width, height, panel);
  return panel;
}

}  // namespace crossnav::app
