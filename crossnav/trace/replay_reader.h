// SPDX-License-Identifier: MIT
// Reads a replay into memory: everything that the page shows. A truncated file (a killed run's
// .part) is read up to the tear.
#pragma once

#include <filesystem>

#include "crossnav/core/result.h"
#include "crossnav/trace/replay.h"

namespace crossnav::trace {

/// Errors name the file and, inside it, the step or the byte.
Result<Replay> ReadReplay(const std::filesystem::path& path);

}  // namespace crossnav::trace
