// SPDX-License-Identifier: MIT
#include "crossnav/core/text_shape.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <climits>

namespace crossnav {
namespace {

/// Index behind the string that opens at `at`; it may not be closed.
std::size_t BehindString(std::string_view text, std::size_t at) {
  const char quote = text[at++];
  while (at < text.size() && text[at] != quote && (quote == '"' || text[at] != '\n')) {
    at += text[at] == '\\' && quote == '"' ? 2 : 1;
  }
  return std::min(at + 1, text.size());
}

bool IsKeyCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

tl::unexpected<Error> TooDeep(const std::string& where) {
  return Fail(ErrorCode::kUnsupported,
              "values are nested deeper than " + std::to_string(kMostNesting) + " levels", where);
}

}  // namespace

Result<void> CheckJsonShape(std::string_view json, const std::string& where) {
  std::array<int, kMostNesting + 1> members{};  // commas of each open value
  int depth = 0;
  for (std::size_t i = 0; i < json.size();) {
    const char c = json[i];
    if (c == '"') {
      i = BehindString(json, i);
      continue;
    }
    ++i;
    if (c == '{' || c == '[') {
      if (++depth > kMostNesting) return TooDeep(where);
      // Lists may be as long as they are.
      members[static_cast<std::size_t>(depth)] = c == '{' ? 0 : INT_MIN;
    } else if (c == '}' || c == ']') {
      depth = std::max(0, depth - 1);
    } else if (c == ',' && ++members[static_cast<std::size_t>(depth)] >= kMostMembers) {
      return Fail(ErrorCode::kUnsupported,
                  "an object has more than " + std::to_string(kMostMembers) + " members", where);
    }
  }
  return {};
}

bool IsUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const int rest = lead < 0x80       ? 0
                     : lead >> 5 == 6  ? 1
                     : lead >> 4 == 14 ? 2
                     : lead >> 3 == 30 ? 3
                                       : -1;
    if (rest < 0) return false;
    std::uint32_t code = rest == 0 ? lead : lead & (0x3FU >> rest);
    for (int k = 0; k < rest; ++k, ++i) {
      if (i == text.size() || (static_cast<unsigned char>(text[i]) >> 6) != 2) return false;
      code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3FU);
    }
    constexpr std::uint32_t kLeast[] = {0, 0x80, 0x800, 0x10000};  // shorter forms are no UTF-8
    if (code < kLeast[rest] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return false;
  }
  return true;
}

std::string PlainReason(std::string_view message) {
  const std::size_t end = message.find("] ");
  if (message.starts_with('[') && end != std::string_view::npos) message.remove_prefix(end + 2);
  return std::string(message);
}

Result<void> CheckTomlShape(std::string_view toml, const std::string& where) {
  if (toml.size() > kMostToml) {
    return Fail(ErrorCode::kUnsupported, "is larger than 1 MiB, which no settings are", where);
  }
  int line = 1, depth = 0, parts = 0;
  bool is_joined = true;  // the next part belongs to the key before it
  for (std::size_t i = 0; i < toml.size();) {
    const char c = toml[i];
    if (IsKeyCharacter(c) || c == '"' || c == '\'') {
      parts = is_joined ? parts + 1 : 1;
      is_joined = false;
      if (c == '"' || c == '\'') {
        const std::size_t end = BehindString(toml, i);
        line += static_cast<int>(std::count(toml.begin() + static_cast<std::ptrdiff_t>(i),
                                            toml.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
        i = end;
      } else {
        while (i < toml.size() && IsKeyCharacter(toml[i])) ++i;
      }
      if (parts > kMostKeyParts) {
        return Fail(ErrorCode::kUnsupported,
                    "a key has more than " + std::to_string(kMostKeyParts) + " parts",
                    where + ": line " + std::to_string(line));
      }
      continue;
    }
    ++i;
    if (c == '#') i = std::min(toml.find('\n', i), toml.size());
    if (c == '\n') ++line;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') depth = std::max(0, depth - 1);
    if (depth > kMostNesting) return TooDeep(where + ": line " + std::to_string(line));
    if (c == '.') {
      is_joined = true;
    } else if (c != ' ' && c != '\t') {
      is_joined = false;
      parts = 0;
    }
  }
  return {};
}

}  // namespace crossnav
