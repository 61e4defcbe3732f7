// SPDX-License-Identifier: MIT
// The JSON forms of a replay's head and of a goal's result (docs/formats/replay.md).
#pragma once

#include <string>
#include <string_view>

#include "crossnav/core/result.h"
#include "crossnav/trace/replay.h"

namespace crossnav::trace {

std::string ToJson(const ReplayInfo& info);
std::string ToJson(const StageResult& stage);
Result<ReplayInfo> ReplayInfoFromJson(std::string_view json);
Result<StageResult> StageResultFromJson(std::string_view json);

}  // namespace crossnav::trace
