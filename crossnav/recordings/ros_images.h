// SPDX-License-Identifier: MIT
// Pixels of ROS images: raw, PNG, JPEG, and the depth of compressed_depth_image_transport.
#pragma once

#include <string>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"
#include "crossnav/recordings/ros_messages.h"

namespace crossnav::recordings {

/// Whether ColourOf reads raw pixels of this encoding.
bool IsColourEncoding(const std::string& encoding);

/// rgb8, bgr8, rgba8, bgra8, 8UC3, 8UC4, mono8 and 8UC1, or a compressed PNG or JPEG. Errors:
/// kUnsupported (another encoding, named), kMalformed (too few bytes, a broken picture).
Result<RgbImage> ColourOf(const RosImage& image, const std::string& where);

/// Planar metres from 16UC1 and mono16 (steps of `unit_m`), 32FC1 (metres), a PNG of 16 bits, or
/// compressedDepth of either (PNG; not RVL). Errors as above.
Result<DepthImage> DepthOf(const RosImage& image, double unit_m, const std::string& where);

}  // namespace crossnav::recordings
