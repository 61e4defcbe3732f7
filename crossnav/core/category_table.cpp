// SPDX-License-Identifier: MIT
#include "crossnav/core/category_table.h"

#include <algorithm>
#include <cctype>

#include "category_data.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/check.h"
#include "crossnav/core/lines.h"
#include "crossnav/core/read_file.h"

namespace crossnav {
Result<CategoryTable> ParseCategoryTable(std::string_view text, const std::string& where) {
  CategoryTable table;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = TakeLine(text);
    if (line.empty() || line.front() == '#') continue;
    const std::string at = where + ", line " + std::to_string(number);
    const std::size_t tab = line.find('\t');
    if (tab == std::string_view::npos || tab == 0 || tab + 1 == line.size()) {
      return Fail(ErrorCode::kMalformed, "expected \"raw name<TAB>category\"", at);
    }
    const std::string category(line.substr(tab + 1));
    if (!IsCategory(category)) {
      return Fail(ErrorCode::kInvalid, "\"" + category + "\" is not one of the six categories", at);
    }
    if (!table.emplace(line.substr(0, tab), category).second) {
      return Fail(ErrorCode::kMalformed, "the raw name is listed twice", at);
    }
  }
  return table;
}

const CategoryTable& DefaultCategories() {
  static const CategoryTable table = [] {
    auto parsed = ParseCategoryTable(kCategoryTsv, "config/categories.tsv");
    CROSSNAV_CHECK(parsed.has_value(), "the built-in category table is broken");
    return *parsed;
  }();
  return table;
}

Result<CategoryTable> ReadCategoryTable(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseCategoryTable(*text, path.string());
}

std::string SpacedName(std::string_view text) {
  std::string name;
  for (char c : text)
    name += c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t first = name.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return name.substr(first, name.find_last_not_of(" \t\r\n") + 1 - first);
}

std::string CanonicalName(std::string_view text) {
  const std::string name = SpacedName(text);
  const auto known = DefaultCategories().find(name);
  return known == DefaultCategories().end() ? name : SpacedName(known->second);
}

}  // namespace crossnav
