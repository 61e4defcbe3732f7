// SPDX-License-Identifier: MIT
// Whole text files, gzip or plain.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "crossnav/core/result.h"

namespace crossnav::evaluation {

/// Reads a file; gzip is recognised by its first bytes.
Result<std::string> ReadTextFile(const std::filesystem::path& path);

/// Writes `text` to a temporary file beside `path` and renames it; gzip if the name ends in .gz.
/// Creates missing folders. The same text gives the same bytes.
Result<void> WriteTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace crossnav::evaluation
