// SPDX-License-Identifier: MIT
// PNG in memory, written and read: the only adapter over libpng. Same image, same bytes (for one
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

/// 8-bit colour, with alpha where `opaque` (0 or 1, same size as `rgb`) is not empty. The image
/// must not be empty; sides are at most kMostPngSide_px.
std::string EncodePng(const RgbImage& rgb, const MaskImage& opaque = {});
/// 8-bit grey; same limits.
std::string EncodePng(const Image<std::uint8_t>& grey);

/// True if the bytes begin with the PNG signature.
bool IsPng(std::span<const std::uint8_t> bytes);

/// Width and height of a PNG; its pixels are not unpacked. kMalformed: no PNG, or broken.
Result<std::array<int, 2>> PngSize(std::span<const std::uint8_t> bytes, const std::string& where);

using Rgba8 = std::array<std::uint8_t, 4>;

/// Any PNG as colour with alpha. kUnsupported: more than 2^26 pixels; kMalformed: broken, or too
/// short to hold its pixels. `where` goes into errors.
Result<Image<Rgba8>> DecodePng(std::span<const std::uint8_t> bytes, const std::string& where);

/// 16-bit grey without conversion. kUnsupported: another kind, or a side above `most_side_px`.
Result<Image<std::uint16_t>> DecodePng16(std::span<const std::uint8_t> bytes, int most_side_px,
                                         const std::string& where);

}  // namespace crossnav
