// SPDX-License-Identifier: MIT
// Writes of whole files: readers see the old or the new content and never a part. Only regular
// files are replaced: symbolic links are followed, devices and pipes refused.
#pragma once

#include <filesystem>
#include <string_view>

#include "crossnav/core/result.h"

namespace crossnav {

/// Regular file that a write to `path` makes or replaces: the end of its links, which may not exist
/// yet. Error kIo: a folder, a device, a pipe, dangling links.
Result<std::filesystem::path> OutputPlace(const std::filesystem::path& path);

/// Writes a temporary file beside the target and renames it; leaves nothing behind on failure. The
/// folder must exist. Errors (kIo) give the system's reason.
Result<void> WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

/// Renames the finished file `part`. On failure `part` is removed.
Result<void> PutInPlace(const std::filesystem::path& part, const std::filesystem::path& place);

}  // namespace crossnav
