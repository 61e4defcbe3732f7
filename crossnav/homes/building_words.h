// SPDX-License-Identifier: MIT
// Architects' vocabulary in a dozen languages -> raw semantic names of objects and types of rooms.
// Texts are compared in small letters without accents; a word may end a longer word ("Doppelbett"),
// because compounds name the object last.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "crossnav/world/plan/plan.h"

namespace crossnav::homes {

/// Small letters without accents; each run of non-letters becomes one space.
std::string FoldedWords(std::string_view utf8);

/// Raw name of the first of `names` with a known word; empty if none has one.
std::string ThingNamed(std::span<const std::string> names);

/// Room type given by a room's name, nullopt if unknown.
std::optional<world::RoomType> RoomTypeNamed(std::string_view name);

/// Whether the name is of a roof, a terrain or a shaft: not a living space.
bool IsNoRoom(std::string_view name);

}  // namespace crossnav::homes
