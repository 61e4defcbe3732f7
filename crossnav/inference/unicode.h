// SPDX-License-Identifier: MIT
// Character data of the tokenizers (config/unicode.txt): classes, lower case, canonical
// composition. Texts are UTF-8 outside and code points inside.
#pragma once

#include <string>
#include <string_view>

namespace crossnav::inference {

/// Invalid bytes become U+FFFD.
std::u32string FromUtf8(std::string_view text);
std::string ToUtf8(std::u32string_view text);

enum class CharClass { kLetter, kNumber, kMark, kPunctuation, kOther, kSeparator, kSpace };

/// kMark: Mn alone; kOther: Cc, Cf, Co and Cs; kSeparator: Zs; kSpace: White_Space.
bool Is(CharClass what, char32_t c);

/// Each character by itself: a final sigma is not special.
std::u32string Lower(std::u32string_view text);

std::u32string Nfd(std::u32string_view text);
std::u32string Nfc(std::u32string_view text);

}  // namespace crossnav::inference
