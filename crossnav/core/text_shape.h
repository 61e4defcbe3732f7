// SPDX-License-Identifier: MIT
// Limits of JSON and TOML texts, checked before a library parses them: libraries recurse into
// nested values, and some search an object's keys linearly for each key. Texts within the limits
// may still be malformed.
#pragma once

#include <string>
#include <string_view>

#include "crossnav/core/result.h"

namespace crossnav {

inline constexpr int kMostNesting = 64;      // chosen: ours have up to 8
inline constexpr int kMostMembers = 10'000;  // chosen: of one object; ours have up to 1000
inline constexpr int kMostKeyParts = 16;     // chosen: "a.b.c" has three; ours have up to 4
inline constexpr std::size_t kMostToml = std::size_t{1} << 20;  // chosen: ours have up to 5 kB

/// kUnsupported where values are nested deeper than kMostNesting, or an object has more members
/// than kMostMembers. `where` names the text.
Result<void> CheckJsonShape(std::string_view json, const std::string& where);

/// kUnsupported where a key has more parts than kMostKeyParts, brackets are nested deeper than
/// kMostNesting, or the text has more than kMostToml bytes. Errors name the line.
Result<void> CheckTomlShape(std::string_view toml, const std::string& where);

/// True if JSON can hold the text.
bool IsUtf8(std::string_view text);

/// Message of a JSON library without the library's own prefix.
std::string PlainReason(std::string_view message);

}  // namespace crossnav
