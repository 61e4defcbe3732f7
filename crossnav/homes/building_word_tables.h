// SPDX-License-Identifier: MIT
// The words of building_words.h, in the spelling of FoldedWords.
#pragma once

#include <span>
#include <string_view>

#include "crossnav/world/plan/plan.h"

namespace crossnav::homes {

struct ThingWord {
  std::string_view word, raw_name;
};
std::span<const ThingWord> ThingWords();
std::span<const ThingWord> NoRoomWords();

struct RoomWord {
  std::string_view word;
  world::RoomType type;
};
std::span<const RoomWord> RoomWords();

}  // namespace crossnav::homes
