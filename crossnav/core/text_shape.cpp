// SPDX-License-Identifier: MIT
#include "crossnav/core/text_shape.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <climits>

namespace crossnav {
namespace {

/// Index behind the string that opens at `at`; accepts unclosed strings.
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
      // Lists have no limit of length.
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

namespace {

/// Number of continuation bytes after the UTF-8 lead byte `lead`; -1: not a lead byte.
int BytesBehind(unsigned char lead) {
  if (lead < 0x80) return 0;
  if (lead >> 5 == 6) return 1;
  if (lead >> 4 == 14) return 2;
  return lead >> 3 == 30 ? 3 : -1;
}

/// Length of the UTF-8 character at the beginning of `text` (not empty); 0: invalid.
std::size_t CharacterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const int rest = BytesBehind(byte(0));
  if (rest < 0 || static_cast<std::size_t>(rest) >= text.size()) return 0;
  const std::size_t length = static_cast<std::size_t>(rest) + 1;
  std::uint32_t code = rest == 0 ? byte(0) : byte(0) & (0x3FU >> rest);
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(i) >> 6 != 2) return 0;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0x80, 0x800,
                                      0x10000};  // shorter forms are not valid UTF-8
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < kLeast[rest] || code > 0x10FFFF || is_surrogate ? 0 : length;
}

}  // namespace

bool IsUtf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = CharacterLength(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string PlainReason(std::string_view message) {
  const std::size_t end = message.find("] ");
  if (message.starts_with('[') && end != std::string_view::npos) message.remove_prefix(end + 2);
  return std::string(message);
}

namespace {

/// Nesting depth behind `c`.
int DepthBehind(char c, int depth) {
  if (c == '[' || c == '{') return depth + 1;
  return c == ']' || c == '}' ? std::max(0, depth - 1) : depth;
}

/// End of the part of a key, or of the value, that begins at `i`.
std::size_t BehindPart(std::string_view toml, std::size_t i) {
  if (toml[i] == '"' || toml[i] == '\'') return BehindString(toml, i);
  while (i < toml.size() && IsKeyCharacter(toml[i])) ++i;
  return i;
}

}  // namespace

Result<void> CheckTomlShape(std::string_view toml, const std::string& where) {
  if (toml.size() > kMostToml) {
    return Fail(ErrorCode::kUnsupported, "is larger than 1 MiB, which no settings are", where);
  }
  int line = 1, depth = 0, parts = 0;
  bool is_joined = true;  // the next part belongs to the key before it
  const auto place = [&] { return where + ": line " + std::to_string(line); };
  for (std::size_t i = 0; i < toml.size();) {
    const char c = toml[i];
    if (IsKeyCharacter(c) || c == '"' || c == '\'') {
      const std::string_view part = toml.substr(i, BehindPart(toml, i) - i);
      line += static_cast<int>(std::count(part.begin(), part.end(), '\n'));
      i += part.size();
      parts = is_joined ? parts + 1 : 1;
      is_joined = false;
      if (parts > kMostKeyParts) {
        return Fail(ErrorCode::kUnsupported,
                    "a key has more than " + std::to_string(kMostKeyParts) + " parts", place());
      }
      continue;
    }
    ++i;
    if (c == '#') i = std::min(toml.find('\n', i), toml.size());
    if (c == '\n') ++line;
    depth = DepthBehind(c, depth);
    if (depth > kMostNesting) return TooDeep(place());
    if (c == ' ' || c == '\t') continue;
    is_joined = c == '.';
    if (!is_joined) parts = 0;
  }
  return {};
}

}  // namespace crossnav
