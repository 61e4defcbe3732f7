// SPDX-License-Identifier: MIT
// Whole files, written so that readers see the old or the new content and never a part. Only
// regular files are ever replaced: symbolic links are followed, devices and pipes refused.
#pragma once

#include <filesystem>
#include <string_view>

#include "crossnav/core/result.h"

namespace crossnav {

/// The regular file that a write to `path` is to make or replace: the end of its links, which need
/// not exist yet. Error kIo: a folder, a device, a pipe, links that lead nowhere.
Result<std::filesystem::path> OutputPlace(const std::filesystem::path& path);

/// Writes beside the file and renames; leaves nothing behind where that fails. Its folder must be
/// there. Errors (kIo) give the system's reason.
Result<void> WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

/// Gives a finished file its name. On failure `part` is removed.
Result<void> PutInPlace(const std::filesystem::path& part, const std::filesystem::path& place);

}  // namespace crossnav
