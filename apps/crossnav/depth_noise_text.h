// SPDX-License-Identifier: MIT
// `bench sensors`: noise of the camera, estimated from its frames (docs/noise.md, "Real cameras").
#pragma once

#include <string>

#include "crossnav/evaluation/episodes/depth_statistics.h"

namespace crossnav::app {

/// A JSON object.
std::string NoiseJson(const evaluation::DepthStatistics& statistics);
/// Two lines.
std::string NoiseText(const evaluation::DepthStatistics& statistics);

}  // namespace crossnav::app
