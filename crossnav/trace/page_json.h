// SPDX-License-Identifier: MIT
// Values that the page reads, whether they stand in its file or come one step after the other.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "crossnav/core/base64.h"
#include "crossnav/core/image.h"
#include "crossnav/trace/json_text.h"
#include "crossnav/trace/replay.h"

namespace crossnav::trace {

/// Grey PNG in base64; empty where there is no depth.
std::string DepthText(const Image<std::uint16_t>& depth_mm);

/// The keys "info", "depth_max_m" and "states" of an object that is open.
void AppendHead(JsonText& json, const ReplayInfo& info);

}  // namespace crossnav::trace
