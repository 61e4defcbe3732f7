// SPDX-License-Identifier: MIT
// Whether a file can be written where it is wanted, found out before the work and not after it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::evaluation {

/// Fails unless a file can be written at `path`. Tries it beside the path and leaves nothing
/// behind, no folders either. `option` names the setting in the message. An empty path is fine.
Result<void> CheckOutputFile(const std::filesystem::path& path, const std::string& option);

/// The same for files in a folder.
Result<void> CheckOutputFolder(const std::filesystem::path& folder, const std::string& option);

/// Fails where `path` is the same file as `input`, which the output would destroy.
Result<void> CheckNotInput(const std::filesystem::path& path, const std::string& option,
                           const std::filesystem::path& input);

/// Fails where one of `inputs` is given twice, by whatever name.
Result<void> CheckNoneTwice(const std::vector<std::filesystem::path>& inputs);

}  // namespace crossnav::evaluation
