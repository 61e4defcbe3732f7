// SPDX-License-Identifier: MIT
// Furnishes a plan room by room by the rules of its type: against walls, in corners, in the middle,
// on tops and on walls. Keeps doors, their leaves, stairs and walkways free; boxes of furniture do
// not overlap by more than kOverlapTolerance_m.
#pragma once

#include <functional>
#include <string_view>

#include "crossnav/core/rng.h"
#include "crossnav/world/furniture/furniture_source.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

inline constexpr double kOverlapTolerance_m = 0.03;  // chosen: handles and rims may touch

void Furnish(HousePlan& plan, const FurnitureSource& source, Rng& rng);

/// Furnishes one room with the kinds (of MakeGroup) that `wants` accepts.
void FurnishRoom(HousePlan& plan, int room, const FurnitureSource& source, Rng& rng,
                 const std::function<bool(std::string_view kind)>& wants);

}  // namespace crossnav::world
