// SPDX-License-Identifier: MIT
// A seeded house without furniture: layout, typed rooms with finishes, stairs, walls, doors,
// windows, railings, balconies, sunken rooms.
#pragma once

#include <string>

#include "crossnav/core/result.h"
#include "crossnav/core/rng.h"
#include "crossnav/world/layout/house_params.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// One attempt; floors and area must be given. kInvalid if the draw fails.
Result<HousePlan> DrawHousePlan(const HouseParams& params, Rng& rng);

std::string_view NameOf(RoomType type);

/// Types for the cells of one level, by size and neighbourhood.
enum class LevelRole { kOnly, kGround, kUpper, kBasement, kOffice };

}  // namespace crossnav::world
