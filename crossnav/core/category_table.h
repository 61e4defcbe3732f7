// SPDX-License-Identifier: MIT
// Category table: maps raw names of scenes, labels of networks and user input to goals. Exact
// names, never substrings.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "crossnav/core/result.h"

namespace crossnav {

/// Raw name -> category of crossnav/core/categories.h.
using CategoryTable = std::map<std::string, std::string, std::less<>>;

/// The built-in table (config/categories.tsv).
const CategoryTable& DefaultCategories();
/// "raw name<TAB>category" lines, '#' comments.
Result<CategoryTable> ReadCategoryTable(const std::filesystem::path& path);
/// Reads the table from text. Errors name `where` and the line.
Result<CategoryTable> ParseCategoryTable(std::string_view text, const std::string& where);

/// "TV_monitor " -> "tv monitor"
std::string SpacedName(std::string_view text);

/// Spaced name of the category that the built-in table gives for `text`, else the spaced text:
/// "Couch" -> "sofa", "TV" -> "tv monitor", "Lamp " -> "lamp".
std::string CanonicalName(std::string_view text);

}  // namespace crossnav
