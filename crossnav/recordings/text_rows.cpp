// SPDX-License-Identifier: MIT
#include "crossnav/recordings/text_rows.h"

#include <charconv>
#include <limits>

#include "crossnav/core/lines.h"

namespace crossnav::recordings {

std::vector<TextRow> RowsOf(std::string_view text) {
  std::vector<TextRow> rows;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = TakeLine(text);
    TextRow row{number, {}};
    std::size_t at = 0;
    while ((at = line.find_first_not_of(" \t", at)) != std::string_view::npos) {
      const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
      row.words.push_back(line.substr(at, end - at));
      at = end;
    }
    if (!row.words.empty() && row.words[0][0] != '#') rows.push_back(std::move(row));
  }
  return rows;
}

std::optional<double> NumberOf(std::string_view word) {
  if (word.find('#') != std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_whole = end.ec == std::errc() && end.ptr == word.data() + word.size();
  return is_whole ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> TimeOf(std::string_view seconds) {
  const std::size_t dot = seconds.find('.');
  const std::string_view whole = seconds.substr(0, dot);
  std::int64_t s = 0, ns = 0;
  const auto end = std::from_chars(whole.data(), whole.data() + whole.size(), s);
  constexpr std::int64_t kMost_s = 9'000'000'000;  // limit of nanoseconds in 64 bits
  if (end.ec != std::errc() || end.ptr != whole.data() + whole.size() || s < 0 || s > kMost_s)
    return std::nullopt;
  const std::string_view part =
      dot == std::string_view::npos ? std::string_view() : seconds.substr(dot + 1);
  std::int64_t unit = 100'000'000;
  for (const char c : part) {
    if (c < '0' || c > '9') return std::nullopt;
    ns += unit * (c - '0');
    unit /= 10;
  }
  return s * 1'000'000'000 + ns;
}

std::optional<std::vector<double>> NumbersOf(const TextRow& row, std::size_t first,
                                             std::size_t count) {
  if (row.words.size() != first + count) return std::nullopt;
  std::vector<double> numbers;
  for (std::size_t i = first; i < row.words.size(); ++i) {
    const auto number = NumberOf(row.words[i]);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace crossnav::recordings
