// SPDX-License-Identifier: MIT
#include "crossnav/inference/unicode.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "crossnav/core/check.h"
#include "unicode_data.h"

namespace crossnav::inference {
namespace {

constexpr char32_t kReplacement = 0xFFFD;
// Hangul syllables are computed (Unicode, section 3.12).
constexpr char32_t kSBase = 0xAC00, kLBase = 0x1100, kVBase = 0x1161, kTBase = 0x11A7;
constexpr char32_t kLCount = 19, kVCount = 21, kTCount = 28, kSCount = kLCount * kVCount * kTCount;

struct CodeRange {
  char32_t first = 0, last = 0;
  std::vector<char32_t> to;  ///< image of `first`, or the class of the range
};

struct Tables {
  std::map<std::string, std::vector<CodeRange>, std::less<>> rows;
  std::map<std::pair<char32_t, char32_t>, char32_t> composed;
};

char32_t Hex(const std::string& text) {
  return static_cast<char32_t>(std::stoul(text, nullptr, 16));
}

/// "a-b=c+d", with optional "-b" and "=c+d".
CodeRange ParseRange(const std::string& item) {
  const auto equals = item.find('=');
  const std::string from = item.substr(0, equals);
  const auto dash = from.find('-');
  CodeRange range{Hex(from.substr(0, dash)), 0, {}};
  range.last = dash == std::string::npos ? range.first : Hex(from.substr(dash + 1));
  if (equals == std::string::npos) return range;
  std::istringstream parts(item.substr(equals + 1));
  for (std::string part; std::getline(parts, part, '+');) range.to.push_back(Hex(part));
  return range;
}

const CodeRange* Find(const std::vector<CodeRange>& ranges, char32_t c) {
  const auto after = std::upper_bound(ranges.begin(), ranges.end(), c,
                                      [](char32_t x, const CodeRange& r) { return x < r.first; });
  if (after == ranges.begin() || std::prev(after)->last < c) return nullptr;
  return &*std::prev(after);
}

Tables ReadTables() {
  Tables tables;
  std::istringstream lines(kUnicodeText);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string name, item;
    words >> name;
    auto& row = tables.rows[name];
    while (words >> item) row.push_back(ParseRange(item));
    std::sort(row.begin(), row.end(),
              [](const CodeRange& a, const CodeRange& b) { return a.first < b.first; });
  }
  for (const CodeRange& range : tables.rows["decompose"])
    if (range.to.size() == 2 && Find(tables.rows["never_composed"], range.first) == nullptr)
      tables.composed[{range.to[0], range.to[1]}] = range.first;
  return tables;
}

const Tables& All() {
  static const Tables tables = ReadTables();
  return tables;
}

const std::vector<CodeRange>& Row(std::string_view name) {
  const auto row = All().rows.find(name);
  CROSSNAV_CHECK(row != All().rows.end(), "config/unicode.txt has every property");
  return row->second;
}

/// Image of `c` in a row of mappings; empty = itself.
std::u32string Mapped(const std::vector<CodeRange>& row, char32_t c) {
  const CodeRange* range = Find(row, c);
  if (range == nullptr) return {};
  if (range->to.size() > 1) return {range->to.begin(), range->to.end()};
  return {static_cast<char32_t>(range->to[0] + (c - range->first))};
}

void Decompose(char32_t c, std::u32string& out) {
  if (c >= kSBase && c < kSBase + kSCount) {
    const char32_t s = c - kSBase;
    out.push_back(kLBase + s / (kVCount * kTCount));
    out.push_back(kVBase + s % (kVCount * kTCount) / kTCount);
    if (s % kTCount != 0) out.push_back(kTBase + s % kTCount);
    return;
  }
  static const std::vector<CodeRange>& row = Row("decompose");
  const std::u32string parts = Mapped(row, c);
  if (parts.empty()) out += c;
  for (const char32_t part : parts) Decompose(part, out);
}

int ClassOf(char32_t c) {
  static const std::vector<CodeRange>& row = Row("class");
  const CodeRange* range = Find(row, c);
  return range == nullptr ? 0 : static_cast<int>(range->to[0]);
}

/// 0 if the two do not compose.
char32_t Compose(char32_t a, char32_t b) {
  if (a >= kLBase && a < kLBase + kLCount && b >= kVBase && b < kVBase + kVCount)
    return kSBase + ((a - kLBase) * kVCount + (b - kVBase)) * kTCount;
  if (a >= kSBase && a < kSBase + kSCount && (a - kSBase) % kTCount == 0 && b > kTBase &&
      b < kTBase + kTCount)
    return a + (b - kTBase);
  const auto it = All().composed.find({a, b});
  return it == All().composed.end() ? 0 : it->second;
}

/// A character and its number of bytes.
std::pair<char32_t, std::size_t> TakeChar(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {kReplacement, 1};
  char32_t c = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {kReplacement, 1};
    c = (c << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_valid = c >= kLeast[length] && c < 0x110000 && (c < 0xD800 || c > 0xDFFF);
  return is_valid ? std::pair(c, length) : std::pair(kReplacement, std::size_t{1});
}

}  // namespace

std::u32string FromUtf8(std::string_view text) {
  std::u32string out;
  while (!text.empty()) {
    const auto [c, length] = TakeChar(text);
    out += c;
    text.remove_prefix(length);
  }
  return out;
}

std::string ToUtf8(std::u32string_view text) {
  std::string out;
  const auto tail = [&](char32_t bits) { out += static_cast<char>(0x80U | (bits & 0x3FU)); };
  for (const char32_t c : text) {
    if (c < 0x80) {
      out += static_cast<char>(c);
    } else if (c < 0x800) {
      out += static_cast<char>(0xC0U | (c >> 6U));
      tail(c);
    } else if (c < 0x10000) {
      out += static_cast<char>(0xE0U | (c >> 12U));
      tail(c >> 6U);
      tail(c);
    } else {
      out += static_cast<char>(0xF0U | (c >> 18U));
      tail(c >> 12U);
      tail(c >> 6U);
      tail(c);
    }
  }
  return out;
}

bool Is(CharClass what, char32_t c) {
  static const std::array rows = {&Row("letter"),      &Row("number"), &Row("mark"),
                                  &Row("punctuation"), &Row("other"),  &Row("separator"),
                                  &Row("space")};
  return Find(*rows[static_cast<std::size_t>(what)], c) != nullptr;
}

std::u32string Lower(std::u32string_view text) {
  static const std::vector<CodeRange>& row = Row("lower");
  std::u32string out;
  for (const char32_t c : text) {
    const std::u32string mapped = Mapped(row, c);
    out += mapped.empty() ? std::u32string(1, c) : mapped;
  }
  return out;
}

std::u32string Nfd(std::u32string_view text) {
  std::u32string out;
  for (const char32_t c : text) Decompose(c, out);
  for (std::size_t begin = 0; begin < out.size();) {
    std::size_t end = begin;
    while (end < out.size() && ClassOf(out[end]) != 0) ++end;
    std::stable_sort(out.begin() + static_cast<std::ptrdiff_t>(begin),
                     out.begin() + static_cast<std::ptrdiff_t>(end),
                     [](char32_t a, char32_t b) { return ClassOf(a) < ClassOf(b); });
    begin = end + 1;
  }
  return out;
}

std::u32string Nfc(std::u32string_view text) {
  const std::u32string apart = Nfd(text);
  std::u32string out;
  std::size_t starter = std::u32string::npos;
  int last_class = 0;  // of the last character between the starter and here
  for (const char32_t c : apart) {
    const int own = ClassOf(c);
    if (starter != std::u32string::npos) {
      const bool is_open = out.size() == starter + 1 || (last_class != 0 && last_class < own);
      if (const char32_t both = is_open ? Compose(out[starter], c) : 0) {
        out[starter] = both;
        continue;
      }
    }
    if (own == 0) starter = out.size();
    last_class = own;
    out += c;
  }
  return out;
}

}  // namespace crossnav::inference
