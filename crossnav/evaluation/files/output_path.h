// SPDX-License-Identifier: MIT
// Checks, before the work begins, that outputs can be written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::evaluation {

/// Fails unless a file can be written at `path`. Tests beside the path and leaves neither files nor
/// folders behind. `option` names the setting in the message. An empty path is fine.
Result<void> CheckOutputFile(const std::filesystem::path& path, const std::string& option);

/// Likewise for files in a folder.
Result<void> CheckOutputFolder(const std::filesystem::path& folder, const std::string& option);

/// Fails if `path` is the same file as `input`, which the output would destroy.
Result<void> CheckNotInput(const std::filesystem::path& path, const std::string& option,
                           const std::filesystem::path& input);

/// Fails if two of `inputs` are the same file under any names.
Result<void> CheckNoneTwice(const std::vector<std::filesystem::path>& inputs);

}  // namespace crossnav::evaluation
