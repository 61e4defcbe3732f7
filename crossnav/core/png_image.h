// SPDX-License-Identifier: MIT
// PNG in memory, written and read: the one adapter over libpng. Same image, same bytes (for one
// version of zlib). Any bytes are safe to read.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"

namespace crossnav {

inline constexpr int kMostPngSide_px = 1'000'000;  ///< libpng's own limit

/// Colour of 8 bits, with alpha where `opaque` (0 or 1, as large as `rgb`) is not empty. The image
/// must not be empty, nor a side above kMostPngSide_px.
std::string EncodePng(const RgbImage& rgb, const MaskImage& opaque = {});
/// Grey of 8 bits; the same.
std::string EncodePng(const Image<std::uint8_t>& grey);

/// Whether they begin as a PNG does.
bool IsPng(std::span<const std::uint8_t> bytes);

using Rgba8 = std::array<std::uint8_t, 4>;

/// Any PNG as colour with alpha. kUnsupported: more than 2^26 pixels; kMalformed: broken, or cut so
/// short that its bytes cannot hold its pixels. `where` goes into errors.
Result<Image<Rgba8>> DecodePng(std::span<const std::uint8_t> bytes, const std::string& where);

/// Grey of 16 bits as it stands. kUnsupported: another kind, or a side above `most_side_px`.
Result<Image<std::uint16_t>> DecodePng16(std::span<const std::uint8_t> bytes, int most_side_px,
                                         const std::string& where);

}  // namespace crossnav
