// SPDX-License-Identifier: MIT
// Semantic text, a small line format, and the category table, whose home is core.
#include <charconv>
#include <map>

#include "crossnav/core/category_table.h"
#include "crossnav/core/lines.h"
#include "crossnav/sim/scene/scene_reader.h"

namespace crossnav::sim {
namespace {

template <class T>
bool ParseNumber(std::string_view text, T& value, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc{} && end == text.data() + text.size();
}

/// `id,HEXRGB,"name, may hold commas",region`; the reason where it is not.
const char* ParseSemanticLine(std::string_view line, SemanticLine& out) {
  const std::size_t comma_1 = line.find(',');
  if (comma_1 == std::string_view::npos) return "expected id,HEXRGB,\"name\",region";
  const std::size_t comma_2 = line.find(',', comma_1 + 1);
  const std::size_t comma_3 = line.rfind(',');
  if (comma_2 == std::string_view::npos || comma_3 <= comma_2) {
    return "expected id,HEXRGB,\"name\",region";
  }
  if (!ParseNumber(line.substr(0, comma_1), out.id) || out.id <= 0) {
    return "the instance id is not a positive number";
  }
  const std::string_view hex = line.substr(comma_1 + 1, comma_2 - comma_1 - 1);
  if (hex.size() != 6 || !ParseNumber(hex, out.colour, 16)) {
    return "the colour is not six hexadecimal digits";
  }
  const std::string_view quoted = line.substr(comma_2 + 1, comma_3 - comma_2 - 1);
  if (quoted.size() < 2 || quoted.front() != '"' || quoted.back() != '"') {
    return "the name is not in double quotes";
  }
  out.name = std::string(quoted.substr(1, quoted.size() - 2));
  if (!ParseNumber(line.substr(comma_3 + 1), out.region)) return "the region is not a number";
  return nullptr;
}

/// Ids and colours that were used before: one note for a file, however many there are.
struct Repetitions {
  int count = 0;
  std::string first;

  void Add(const std::string& at, const char* kind, int line_before) {
    if (count++ == 0) {
      first = at + ": " + kind + " is already used in line " + std::to_string(line_before);
    }
  }
  std::string Text() const {
    return first + (count > 1 ? " (and " + std::to_string(count - 1) + " more)" : "") +
           "; the first line with an id names it, the first with a colour has its surfaces";
  }
};

}  // namespace

Result<std::vector<SemanticLine>> ParseSemanticText(std::string_view text, const std::string& where,
                                                    std::vector<std::string>* notes) {
  if (TakeLine(text).find("HM3D Semantic Annotations") == std::string_view::npos) {
    return Fail(ErrorCode::kMalformed, "the header \"HM3D Semantic Annotations\" is missing",
                where + ", line 1");
  }
  std::vector<SemanticLine> lines;
  std::map<int, int> line_of_id;
  std::map<std::uint32_t, int> line_of_colour;
  Repetitions again;
  for (int number = 2; !text.empty(); ++number) {
    const std::string_view line = TakeLine(text);
    if (line.empty()) continue;
    const std::string at = where + ", line " + std::to_string(number);
    SemanticLine parsed;
    if (const char* reason = ParseSemanticLine(line, parsed)) {
      return Fail(ErrorCode::kMalformed, reason, at);
    }
    const auto [id, is_new_id] = line_of_id.emplace(parsed.id, number);
    const auto [colour, is_new_colour] = line_of_colour.emplace(parsed.colour, number);
    if (!is_new_id) again.Add(at, "instance id", id->second);
    if (!is_new_colour) again.Add(at, "colour", colour->second);
    lines.push_back(std::move(parsed));
  }
  if (again.count > 0 && notes != nullptr) notes->push_back(again.Text());
  return lines;
}

Result<CategoryTable> ParseCategoryTable(std::string_view text, const std::string& where) {
  return crossnav::ParseCategoryTable(text, where);
}

const CategoryTable& DefaultCategories() {
  return crossnav::DefaultCategories();
}

Result<CategoryTable> ReadCategoryTable(const std::filesystem::path& path) {
  return crossnav::ReadCategoryTable(path);
}

}  // namespace crossnav::sim
