// SPDX-License-Identifier: MIT
// Words that architects write, in a dozen languages -> raw semantic names of things and types of
// rooms. Texts are compared in small letters without accents; a word may end a longer one
// ("Doppelbett"), since compounds name the thing last.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "crossnav/world/plan/plan.h"

namespace crossnav::homes {

/// Small letters without accents; all but letters of any script becomes single spaces.
std::string FoldedWords(std::string_view utf8);

/// The raw name that the first telling one of `names` has; empty where none says anything.
std::string ThingNamed(std::span<const std::string> names);

/// The type that a room's name says, nullopt where it says none.
std::optional<world::RoomType> RoomTypeNamed(std::string_view name);

/// Whether the name is that of a roof, a terrain or a shaft: nobody lives there.
bool IsNoRoom(std::string_view name);

}  // namespace crossnav::homes
