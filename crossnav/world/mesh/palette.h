// SPDX-License-Identifier: MIT
// Colours of furniture and surfaces (sRGB). Categories share palettes, so that a colour never gives
// a category away.
#pragma once

#include <array>
#include <span>

#include "crossnav/core/image.h"
#include "crossnav/core/rng.h"

namespace crossnav::world {

inline constexpr std::array<Rgb8, 7> kWoods = {Rgb8{176, 132, 88}, {142, 98, 62}, {98, 66, 44},
                                               {204, 168, 122},    {70, 52, 42},  {188, 150, 110},
                                               {222, 210, 192}};
inline constexpr std::array<Rgb8, 10> kFabrics = {
    Rgb8{92, 104, 122}, {134, 60, 54},   {196, 180, 156}, {72, 96, 76},  {58, 62, 72},
    {168, 122, 74},     {150, 152, 156}, {108, 78, 96},   {40, 72, 104}, {212, 206, 198}};
inline constexpr std::array<Rgb8, 6> kLinens = {Rgb8{236, 234, 228}, {198, 212, 224},
                                                {214, 196, 176},     {154, 170, 156},
                                                {120, 132, 160},     {206, 178, 184}};
inline constexpr std::array<Rgb8, 4> kMetals = {
    Rgb8{150, 152, 155}, {60, 62, 66}, {196, 198, 200}, {110, 96, 78}};
inline constexpr std::array<Rgb8, 6> kPots = {Rgb8{166, 88, 58}, {226, 222, 214}, {70, 72, 76},
                                              {120, 130, 118},   {188, 150, 110}, {54, 82, 110}};
inline constexpr std::array<Rgb8, 5> kLeaves = {
    Rgb8{52, 108, 48}, {70, 128, 58}, {38, 84, 44}, {96, 140, 70}, {60, 96, 66}};
inline constexpr std::array<Rgb8, 3> kPorcelains = {
    Rgb8{244, 244, 242}, {236, 232, 222}, {250, 250, 250}};
inline constexpr Rgb8 kScreenBlack{18, 18, 22};

inline Rgb8 Pick(std::span<const Rgb8> colours, Rng& rng) {
  return colours[rng.Below(static_cast<std::uint32_t>(colours.size()))];
}

/// `c` scaled in brightness.
inline Rgb8 Shade(Rgb8 c, double factor) {
  const auto f = [factor](std::uint8_t v) {
    return static_cast<std::uint8_t>(std::min(255.0, std::max(0.0, v * factor + 0.5)));
  };
  return {f(c.r), f(c.g), f(c.b)};
}

}  // namespace crossnav::world
