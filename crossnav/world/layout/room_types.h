// SPDX-License-Identifier: MIT
// Types and finishes of rooms.
#pragma once

#include "crossnav/world/layout/house_plan.h"
#include "crossnav/world/layout/layout.h"

namespace crossnav::world {

/// One type per cell. The largest cell becomes the living room (or main bedroom), the smallest the
/// bathroom; a cell entered through another cell gets a matching type.
std::vector<RoomType> DrawRoomTypes(const LevelLayout& level, LevelRole role, Rng& rng);

/// Colours and patterns of floor, walls and ceiling.
void DrawFinishes(Room& room, Rng& rng);

}  // namespace crossnav::world
