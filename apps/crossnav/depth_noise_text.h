// SPDX-License-Identifier: MIT
// `bench sensors`: what the frames tell of the noise of their camera (docs/noise.md, "Real
// cameras").
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "crossnav/evaluation/episodes/depth_statistics.h"

namespace crossnav::app {

nlohmann::ordered_json NoiseJson(const evaluation::DepthStatistics& statistics);
std::string NoiseText(const nlohmann::ordered_json& noise);

}  // namespace crossnav::app
