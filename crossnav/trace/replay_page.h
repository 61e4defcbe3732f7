// SPDX-License-Identifier: MIT
// Self-contained page of a replay: one HTML file that opens from disk without a network. The replay
// is the only input.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "crossnav/core/result.h"
#include "crossnav/trace/replay.h"

namespace crossnav::trace {

/// The page's HTML. `other`: a second run of the same episode, to compare with.
std::string ReplayPage(const Replay& replay, const Replay* other = nullptr);

/// The page without a replay: it follows the events (live_events.h) that `events`, an address
/// relative to its own, sends.
std::string LivePage(std::string_view events);

/// Reads the replay at `mcap_path` and writes the page to `html_path` (whole, or not at all).
Result<void> ExportReplayPage(const std::filesystem::path& mcap_path,
                              const std::filesystem::path& html_path);

/// Page of two replays of one episode; replays of different episodes are an error.
Result<void> ExportComparison(const std::filesystem::path& mcap_path,
                              const std::filesystem::path& other_path,
                              const std::filesystem::path& html_path);

}  // namespace crossnav::trace
