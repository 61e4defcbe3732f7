// SPDX-License-Identifier: MIT
// `bench sensors`: two Kinect frames of one flight of stairs, by geometry alone and with the mask
// of a network (docs/recordings.md, "Held to real sensors").
#pragma once

#include <filesystem>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/perception/perception.h"

namespace crossnav::app {

/// Findings, as a JSON array with one object per frame and as text.
struct StairFrames {
  std::string json, text;
};

/// `folder` holds 0000_depth.png, 0000_color.png, 0000_imu.txt and the same of 0001. Without
/// `suite` by geometry alone.
Result<StairFrames> TryStairs(const std::filesystem::path& folder,
                              perception::PerceptionSuite* suite);

}  // namespace crossnav::app
