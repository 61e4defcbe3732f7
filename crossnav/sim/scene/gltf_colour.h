// SPDX-License-Identifier: MIT
// Colours of glTF as bytes. Private to the glTF reader.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace crossnav::sim {

inline std::uint8_t ToByte(double unit) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(unit, 0.0, 1.0) * 255));
}

inline std::uint8_t LinearToSrgb(double linear) {
  if (!(linear > 0)) return 0;
  return ToByte(linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

}  // namespace crossnav::sim
