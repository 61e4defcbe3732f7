// SPDX-License-Identifier: MIT
// Walls follow from the rooms: where two rooms, or a room and the outside, meet.
#pragma once

#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// Appends the walls of every level; each piece separates one pair of rooms. A void is open towards
/// halls (it gets a railing instead), a balcony towards the outside.
void DeriveWalls(HousePlan& plan, const SurfaceFinish& outside);

/// Index of the room of `level` that holds `p`, -1 = outside.
int RoomAt(const HousePlan& plan, int level, const Vector2d& p);

/// The longest wall between two rooms (either order; -1 = outside), or nullptr.
Wall* FindWall(HousePlan& plan, int room_a, int room_b);

/// Adds the opening where it overlaps no other one and stays off the wall's ends; false where it
/// does not fit. `opening.center_m` is along the wall.
bool AddOpening(Wall& wall, const Opening& opening);

}  // namespace crossnav::world
