// SPDX-License-Identifier: MIT
// Depth images of 16 bits in files and messages -> metres.
#pragma once

#include <span>
#include <string>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"

namespace crossnav::recordings {

inline constexpr int kMostSide_px = 8192;  ///< of an image, as sensor.width_px

/// Binary PGM (P5) of 16 bits without conversion, H x W. Errors: kMalformed.
Result<Image<std::uint16_t>> DecodePgm16(std::span<const std::uint8_t> bytes,
                                         const std::string& where);

/// PNG or PGM, by content.
Result<Image<std::uint16_t>> DecodeDepth16(std::span<const std::uint8_t> bytes,
                                           const std::string& where);

/// Planar depth [m]; 0 and 65535 (7-Scenes and some drivers) are invalid.
DepthImage DepthOf(const Image<std::uint16_t>& raw, double unit_m);

}  // namespace crossnav::recordings
