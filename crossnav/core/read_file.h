// SPDX-License-Identifier: MIT
// Whole files as bytes. All readers of files that fit into memory use these functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "crossnav/core/result.h"

namespace crossnav {

/// Size of a regular file [bytes]. Errors: kNotFound, kIo (a folder, a device, a pipe).
Result<std::uintmax_t> SizeOfFile(const std::filesystem::path& path);

/// Errors: those of SizeOfFile, kIo (reading fails), kUnsupported (more than `max_bytes`).
Result<std::string> ReadFile(const std::filesystem::path& path,
                             std::uintmax_t max_bytes = UINTMAX_MAX);

}  // namespace crossnav
