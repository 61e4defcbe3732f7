// SPDX-License-Identifier: MIT
// Turns a whole plan about the origin, before it is furnished.
#pragma once

#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

void TurnPlan(HousePlan& plan, int quarter_turns);

}  // namespace crossnav::world
