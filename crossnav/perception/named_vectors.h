// SPDX-License-Identifier: MIT
// Text vectors from two files: names, one a line, and an array (.npy) with a row for each.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::perception {

/// By name in lower case; all of one length, all finite, not normalised.
using NamedVectors = std::map<std::string, std::vector<float>, std::less<>>;

/// Errors name the file.
Result<NamedVectors> ReadNamedVectors(const std::filesystem::path& names,
                                      const std::filesystem::path& rows);

}  // namespace crossnav::perception
