// SPDX-License-Identifier: MIT
// Colour and small picture of an object in one colour image.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "crossnav/core/image.h"

namespace crossnav::objects {

inline constexpr int kPictureSide_px = 64;

/// Pixels [u0, u1) x [v0, v1).
struct PictureBox {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
};

/// Mean red, green, blue of the pixels of `mask` in the box; empty without pixels, or if all are
/// black: a simulator without colours renders black.
std::optional<std::array<std::uint8_t, 3>> MeanColour(const RgbImage& rgb, const MaskImage& mask,
                                                      const PictureBox& box);

/// The box and a tenth around it, by means over areas, as PNG of at most kPictureSide_px a side.
std::vector<std::uint8_t> PictureOf(const RgbImage& rgb, const PictureBox& box);

}  // namespace crossnav::objects
