// SPDX-License-Identifier: MIT
// Small camera images for a replay: colour as JPEG, depth as millimetres in 16 bits. Same input,
// same bytes (for one version of libjpeg).
#pragma once

#include <cstdint>
#include <string>

#include "crossnav/core/image.h"

namespace crossnav::trace {

/// Smallest whole factor by which an image of `size_px` must shrink to be at most `max_px`.
int ShrinkFactor(int size_px, int max_px);

/// Mean over factor x factor blocks; drops the rest at the right and bottom edge.
RgbImage Shrink(const RgbImage& rgb, int factor);

/// Depth in millimetres, 0 = invalid, one sample per factor x factor block (never a mean: that
/// would invent surfaces at edges). Values over 65.535 m become 0.
Image<std::uint16_t> ShrinkDepthMm(const DepthImage& depth_m, int factor);

/// Baseline JPEG; quality 1..100. The image must not be empty.
std::string EncodeJpeg(const RgbImage& rgb, int quality);

/// Grey PNG of 8 bits: 0 = invalid, 1..255 = 0..`max_m` (larger depths are 255).
std::string EncodeDepthPng(const Image<std::uint16_t>& depth_mm, double max_m);

}  // namespace crossnav::trace
