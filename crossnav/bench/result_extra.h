// SPDX-License-Identifier: MIT
// Key `extra` of a stage in result records.
#pragma once

#include "crossnav/bench/episode_record.h"
#include "crossnav/bench/result_line.h"

namespace crossnav::bench {

Json ExtraJson(const StageExtra& extra);

/// Keys that are absent, as in old records, stay empty.
StageExtra ReadExtra(const ResultLine& line, std::optional<Error>& error);

}  // namespace crossnav::bench
