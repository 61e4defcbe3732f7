// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::sim {

/// Writes beside `file` and renames, so that readers see the old or the new content, never a part.
Result<void> WriteFileAtomically(const std::filesystem::path& file,
                                 const std::vector<std::uint8_t>& bytes);

}  // namespace crossnav::sim
