// SPDX-License-Identifier: MIT
// Shapes beyond rectangles: round corners, columns, sloping ceilings. They are blocks of the shell
// and keep clear of doors, stairs and voids. Canonical frame, before the plan is turned.
#pragma once

#include "crossnav/core/rng.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// Fills corners of a share of the rooms with quarter circles and puts columns into large rooms.
void RoundRooms(HousePlan& plan, double chance, Rng& rng);

/// A roof over the top level with slopes above the facades y = 0 and y = `depth_m`. Windows below a
/// slope are lowered or removed.
void SlopeTopLevel(HousePlan& plan, double depth_m, Rng& rng);

}  // namespace crossnav::world
