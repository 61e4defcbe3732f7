// SPDX-License-Identifier: MIT
// Furniture of a room by its type.
#pragma once

#include <span>
#include <string_view>

#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

enum class Where { kWall, kCorner, kMiddle, kFacingTv, kOnWall, kCeiling };

struct Rule {
  std::string_view kind;  ///< of MakeGroup
  Where where = Where::kWall;
  double chance = 1;
  int most = 1;            ///< tries, each with `chance`
  double min_area_m2 = 0;  ///< of the room
};

/// In order of placement, important pieces first.
std::span<const Rule> RulesOf(RoomType type);

}  // namespace crossnav::world
