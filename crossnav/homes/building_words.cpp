// SPDX-License-Identifier: MIT
#include "crossnav/homes/building_words.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "crossnav/homes/building_word_tables.h"

namespace crossnav::homes {
namespace {

// Base letters of U+00C0 to U+017F.
constexpr std::string_view kLatin =
    "aaaaaaaceeeeiiiidnooooo ouuuuytsaaaaaaaceeeeiiiidnooooo ouuuuyty"
    "aaaaaaccccccccddddeeeeeeeeeegggggggghhhhiiiiiiiiiiiijjkkklllllllllln"
    "nnnnnnnnoooooooorrrrrrssssssssttttttuuuuuuuuuuuuwwyyyzzzzzzs";
static_assert(kLatin.size() == 0x180 - 0xC0);
constexpr std::size_t kMinCompound = 5;  // chosen: "street" must not match "tree"

/// The code point at `at`, which advances; 0 for invalid UTF-8 or more than three bytes.
std::uint32_t Next(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const std::uint32_t first = byte(at);
  const std::size_t more = first < 0x80 ? 0 : first >> 5 == 6 ? 1 : first >> 4 == 14 ? 2 : 3;
  std::uint32_t code = more == 0 ? first : more == 1 ? first & 0x1F : first & 0x0F;
  for (std::size_t i = 1; i <= more; ++i) {
    if (more == 3 || byte(at + i) >> 6 != 2) {
      ++at;
      return 0;
    }
    code = code << 6 | (byte(at + i) & 0x3F);
  }
  at += more + 1;
  return code;
}

void Append(std::string& out, std::uint32_t code) {
  if (code < 0x800) {
    out.push_back(static_cast<char>(0xC0 | code >> 6));
  } else {
    out.push_back(static_cast<char>(0xE0 | code >> 12));
    out.push_back(static_cast<char>(0x80 | (code >> 6 & 0x3F)));
  }
  out.push_back(static_cast<char>(0x80 | (code & 0x3F)));
}

void AppendFolded(std::string& out, std::uint32_t code) {
  if (code < 0x80) {
    const bool is_letter = std::isalpha(static_cast<int>(code)) != 0;
    out.push_back(is_letter ? static_cast<char>(std::tolower(static_cast<int>(code))) : ' ');
  } else if (code == 0xDF) {
    out += "ss";
  } else if (code == 0xC6 || code == 0xE6) {
    out += "ae";
  } else if (code >= 0xC0 && code < 0x180) {
    out.push_back(kLatin[code - 0xC0]);
  } else if (code < 0xC0 || (code >= 0x2000 && code < 0x2070) || code == 0x3000) {
    out.push_back(' ');
  } else {
    Append(out, code >= 0x410 && code <= 0x42F ? code + 0x20 : code);
  }
}

/// Whether the text from `end` on is the end of a word or of its plural.
bool IsEnd(std::string_view text, std::size_t end) {
  for (const std::string_view plural : {"", "s", "es", "n", "en"}) {
    if (text.substr(end, plural.size()) != plural) continue;
    const std::size_t next = end + plural.size();
    if (next >= text.size() || text[next] == ' ') return true;
  }
  return false;
}

bool Holds(std::string_view text, std::string_view word) {
  // the word itself contains spaces
  const bool has_spaces = static_cast<unsigned char>(word[0]) < 0xE0;
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    if (!has_spaces) return true;
    const bool is_start = at == 0 || text[at - 1] == ' ';
    if ((is_start || word.size() >= kMinCompound) && IsEnd(text, at + word.size())) return true;
  }
  return false;
}

/// The entry with the longest word contained in `text`.
template <class Entry>
const Entry* Longest(std::span<const Entry> table, std::string_view text) {
  const Entry* best = nullptr;
  for (const Entry& entry : table) {
    if (best != nullptr && entry.word.size() <= best->word.size()) continue;
    if (Holds(text, entry.word)) best = &entry;
  }
  return best;
}

}  // namespace

std::string FoldedWords(std::string_view utf8) {
  std::string all;
  bool was_small = false;
  for (std::size_t at = 0; at < utf8.size();) {
    const std::uint32_t code = Next(utf8, at);
    const bool is_capital = code < 0x80 && std::isupper(static_cast<int>(code)) != 0;
    if (is_capital && was_small) all.push_back(' ');  // "OfficeChair"
    was_small = code < 0x80 && std::islower(static_cast<int>(code)) != 0;
    AppendFolded(all, code);
  }
  std::string out;
  for (const char c : all) {
    if (c != ' ' || (!out.empty() && out.back() != ' ')) out.push_back(c);
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

std::string ThingNamed(std::span<const std::string> names) {
  for (const std::string& name : names) {
    const auto* entry = Longest<ThingWord>(ThingWords(), FoldedWords(name));
    if (entry != nullptr) return std::string(entry->raw_name);
  }
  return {};
}

std::optional<world::RoomType> RoomTypeNamed(std::string_view name) {
  const auto* entry = Longest<RoomWord>(RoomWords(), FoldedWords(name));
  return entry == nullptr ? std::nullopt : std::optional(entry->type);
}

bool IsNoRoom(std::string_view name) {
  const auto* none = Longest<ThingWord>(NoRoomWords(), FoldedWords(name));
  if (none == nullptr) return false;
  const auto* room = Longest<RoomWord>(RoomWords(), FoldedWords(name));
  return room == nullptr || room->word.size() < none->word.size();
}

}  // namespace crossnav::homes
