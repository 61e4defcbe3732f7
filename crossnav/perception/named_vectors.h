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

/// The names that a file lists. Errors name the file.
Result<std::vector<std::string>> ReadNames(const std::filesystem::path& path);

/// A row of `rows` for each name, in that order. Errors name the file.
Result<NamedVectors> ReadNamedVectors(const std::vector<std::string>& names,
                                      const std::filesystem::path& rows);
Result<NamedVectors> ReadNamedVectors(const std::filesystem::path& names,
                                      const std::filesystem::path& rows);

}  // namespace crossnav::perception
