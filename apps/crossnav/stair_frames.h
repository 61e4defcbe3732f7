// SPDX-License-Identifier: MIT
// `bench sensors`: two Kinect frames of one flight of stairs, by geometry alone and with the mask
// of a network (docs/recordings.md, "Held to real sensors").
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/perception/perception.h"

namespace crossnav::app {

using Json = nlohmann::ordered_json;

/// `folder` holds 0000_depth.png, 0000_color.png, 0000_imu.txt and the same of 0001. Without
/// `suite` by geometry alone. One object a frame.
Result<Json> TryStairs(const std::filesystem::path& folder, perception::PerceptionSuite* suite);

std::string StairsText(const Json& frames);

}  // namespace crossnav::app
