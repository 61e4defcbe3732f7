// SPDX-License-Identifier: MIT
#include "crossnav/world/surface/textures.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "crossnav/core/rng.h"

namespace crossnav::world {
namespace {

constexpr int kSize_px = 256;

double Hash01(int x, int y, std::uint64_t seed) {
  const auto cell = static_cast<std::uint64_t>(x) << 32 | static_cast<std::uint32_t>(y);
  return static_cast<double>(MixSeed(cell, seed) >> 11) * 0x1p-53;
}

/// Smooth noise in [0, 1) that repeats every `period` cells.
double Noise(double x, double y, int period, std::uint64_t seed) {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto wrap = [period](int i) { return ((i % period) + period) % period; };
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double fx = smooth(x - x0), fy = smooth(y - y0);
  const auto at = [&](int i, int j) { return Hash01(wrap(i), wrap(j), seed); };
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
         fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

/// Several octaves of Noise; u, v in [0, 1).
double Turbulence(double u, double v, int cells, std::uint64_t seed) {
  double sum = 0, weight = 0.5;
  for (int octave = 0; octave < 4; ++octave, cells *= 2, weight *= 0.5) {
    sum += weight * Noise(u * cells, v * cells, cells, MixSeed(seed, octave));
  }
  return sum / 0.9375;
}

double Planks(double u, double v, std::uint64_t seed) {
  constexpr int kRows = 8;
  const int row = static_cast<int>(v * kRows);
  const double shift = Hash01(row, 7, seed);
  const double along = std::fmod(u + shift, 1.0) * 2;  // two boards per repeat
  const int board = static_cast<int>(along);
  const double across = v * kRows - row, end = along - board;
  const bool is_joint = across < 0.04 || end < 0.004;
  const double tone = 0.86 + 0.14 * Hash01(row, 31 + board, seed);
  const double grain = Turbulence(u, v, 4, MixSeed(seed, 3)) * 0.5 +
                       0.5 * Noise(u * 6, v * 96, 96, MixSeed(seed, 4));
  return is_joint ? 0.45 : tone * (0.84 + 0.16 * grain);
}

double Tiles(double u, double v, std::uint64_t seed) {
  constexpr int kTiles = 4;
  const int i = static_cast<int>(u * kTiles), j = static_cast<int>(v * kTiles);
  const double a = u * kTiles - i, b = v * kTiles - j;
  if (a < 0.02 || b < 0.02) return 0.68;  // grout
  return 0.93 + 0.05 * Hash01(i, j, seed) - 0.04 * Turbulence(u, v, 8, seed);
}

double Brick(double u, double v, std::uint64_t seed) {
  constexpr int kRows = 12;
  const int row = static_cast<int>(v * kRows);
  const double x = std::fmod(u * 4 + (row % 2 ? 0.5 : 0.0), 4.0);
  const int i = static_cast<int>(x);
  if (x - i < 0.05 || v * kRows - row < 0.14) return 0.95;  // mortar
  return 0.62 + 0.2 * Hash01(i, row, seed) - 0.1 * Turbulence(u, v, 16, seed);
}

double Plaster(double u, double v, std::uint64_t seed) {
  return 0.94 + 0.06 * Turbulence(u, v, 12, seed) +
         0.015 * (Noise(u * 128, v * 128, 128, seed) - 0.5);
}

double Carpet(double u, double v, std::uint64_t seed) {
  return 0.72 + 0.2 * Noise(u * 128, v * 128, 128, seed) + 0.08 * Turbulence(u, v, 8, seed);
}

}  // namespace

double PatternSize(Pattern pattern) {
  switch (pattern) {
    case Pattern::kPlanks:  // boards 15 cm wide, 60 cm long
    case Pattern::kTiles:   // 30 cm
      return 1.2;
    case Pattern::kBrick:
      return 1.0;
    case Pattern::kCarpet:
      return 0.6;
    default:
      return 1.5;
  }
}

sim::Texture MakePattern(Pattern pattern, std::uint64_t seed) {
  double (*value)(double, double, std::uint64_t) = nullptr;
  switch (pattern) {
    case Pattern::kPlanks:
      value = Planks;
      break;
    case Pattern::kTiles:
      value = Tiles;
      break;
    case Pattern::kBrick:
      value = Brick;
      break;
    case Pattern::kCarpet:
      value = Carpet;
      break;
    case Pattern::kPlaster:
      value = Plaster;
      break;
    case Pattern::kPlain:
      return {};
  }
  sim::Texture texture;
  texture.rgb = RgbImage(kSize_px, kSize_px);
  for (int y = 0; y < kSize_px; ++y) {
    for (int x = 0; x < kSize_px; ++x) {
      const double f = value((x + 0.5) / kSize_px, (y + 0.5) / kSize_px, seed);
      const auto b = static_cast<std::uint8_t>(std::lround(std::clamp(f, 0.0, 1.0) * 255));
      texture.rgb.At(x, y) = {b, b, b};
    }
  }
  return texture;
}

}  // namespace crossnav::world
