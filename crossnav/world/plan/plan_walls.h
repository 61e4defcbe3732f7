// SPDX-License-Identifier: MIT
// Derives walls from rooms: at each border between two rooms, or between a room and the outside.
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

/// Adds the opening if it overlaps no other opening and stays off the wall's ends; else returns
/// false. `opening.center_m` is along the wall.
bool AddOpening(Wall& wall, const Opening& opening);

}  // namespace crossnav::world
