// SPDX-License-Identifier: MIT
// Which room is what, and what it looks like.
#pragma once

#include "crossnav/world/layout/house_plan.h"
#include "crossnav/world/layout/layout.h"

namespace crossnav::world {

/// One type per cell. The largest cell becomes the living room (or main bedroom), the smallest the
/// bathroom; a cell entered through another one gets a type that belongs to it.
std::vector<RoomType> DrawRoomTypes(const LevelLayout& level, LevelRole role, Rng& rng);

/// Colours and patterns of floor, walls and ceiling.
void DrawFinishes(Room& room, Rng& rng);

}  // namespace crossnav::world
