// SPDX-License-Identifier: MIT
// Living rooms, kitchens and dining rooms of a level without walls between them.
#pragma once

#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// Joins adjacent rooms of `rooms`, sometimes with the hall. Before the walls are derived.
void OpenLevel(HousePlan& plan, const std::vector<int>& rooms, int hall, Rng& rng);

/// True if the two rooms need no door between them.
bool IsOpenBetween(const HousePlan& plan, int room_a, int room_b);

}  // namespace crossnav::world
