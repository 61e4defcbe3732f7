// SPDX-License-Identifier: MIT
// Text files of words in rows, common to several formats.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace crossnav::recordings {

struct TextRow {
  int line = 0;  ///< from 1
  std::vector<std::string_view> words;
};

/// Rows that are not empty and do not begin with #; views into `text`.
std::vector<TextRow> RowsOf(std::string_view text);

/// A decimal number, or NaN for the spelling of some programs ("-1.#IND").
std::optional<double> NumberOf(std::string_view word);

/// Decimal seconds as nanoseconds, without rounding them through a double.
std::optional<std::int64_t> TimeOf(std::string_view seconds);

/// The words from `first` on as numbers; empty unless there are exactly `count`, all numbers.
std::optional<std::vector<double>> NumbersOf(const TextRow& row, std::size_t first,
                                             std::size_t count);

}  // namespace crossnav::recordings
