// SPDX-License-Identifier: MIT
// Key `extra` of a stage in result records.
#pragma once

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/records/result_line.h"

namespace crossnav::evaluation {

Json ExtraJson(const StageExtra& extra);

/// Keys that are absent, as in old records, stay empty.
StageExtra ReadExtra(const ResultLine& line, std::optional<Error>& error);

}  // namespace crossnav::evaluation
