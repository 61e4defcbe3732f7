// SPDX-License-Identifier: MIT
// Text vectors from two files: names, one a line, and an array (.npy) with a row for each.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::perception {

/// By name in lower case; equal lengths, finite, not normalised.
using NamedVectors = std::map<std::string, std::vector<float>, std::less<>>;

/// Names in a file, one a line. Errors name the file.
Result<std::vector<std::string>> ReadNames(const std::filesystem::path& path);

/// One row of `rows` for each name, in order. Errors name the file.
Result<NamedVectors> ReadNamedVectors(const std::vector<std::string>& names,
                                      const std::filesystem::path& rows);
Result<NamedVectors> ReadNamedVectors(const std::filesystem::path& names,
                                      const std::filesystem::path& rows);

}  // namespace crossnav::perception
