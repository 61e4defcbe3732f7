// SPDX-License-Identifier: MIT
// The shell of a home: floors and ceilings of rooms, walls with their openings.
#pragma once

#include <functional>

#include "crossnav/homes/home_plan.h"
#include "crossnav/world/shell/scene_builder.h"

namespace crossnav::homes {

/// Makes a finish the scene's current material; the colour is that of surfaces without one.
using UseFinish = std::function<void(const Finish&, Rgb8 otherwise)>;

/// Part of a level's slab that belongs to the floor; the rest is the ceiling's below. [0, 1]
inline constexpr double kFloorShare = 0.6;

/// Thickness of what lies between the ceiling of `level` and the next floor above, or of a roof
/// [m].
double SlabAbove(const HomePlan& plan, int level);

/// The room of `level` (or of one at the same height) at `p`, -1 where there is none.
int RoomAt(const HomePlan& plan, int level, const Vector2d& p);

/// Floors and ceilings, with the cut-outs of the staircases that pass through them.
void BuildRooms(const HomePlan& plan, const UseFinish& use, world::SceneBuilder& scene);

void BuildWalls(const HomePlan& plan, const UseFinish& use, world::SceneBuilder& scene);

/// Centre line of a wall: two points, more for an arc.
std::vector<Vector2d> CentreLine(const HomeWall& wall);

}  // namespace crossnav::homes
