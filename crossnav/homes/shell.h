// SPDX-License-Identifier: MIT
// The shell of a home: floors and ceilings of rooms, walls with their openings.
#pragma once

#include <functional>

#include "crossnav/homes/home_plan.h"
#include "crossnav/world/shell/scene_builder.h"

namespace crossnav::homes {

/// Makes a finish the scene's current material; `otherwise` is the colour of surfaces without a
/// finish.
using UseFinish = std::function<void(const Finish&, Rgb8 otherwise)>;

/// Share of a level's slab that belongs to the floor; the rest belongs to the ceiling below. [0, 1]
inline constexpr double kFloorShare = 0.6;

/// Thickness between the ceiling of `level` and the next floor above, or of a roof [m].
double SlabAbove(const HomePlan& plan, int level);

/// The room of `level` (or of a level at the same height) at `p`, -1 without a room.
int RoomAt(const HomePlan& plan, int level, const Vector2d& p);

/// Floors and ceilings, with the cut-outs of staircases.
void BuildRooms(const HomePlan& plan, const UseFinish& use, world::SceneBuilder& scene);

void BuildWalls(const HomePlan& plan, const UseFinish& use, world::SceneBuilder& scene);

/// Centre line of a wall: two points, more for an arc.
std::vector<Vector2d> CentreLine(const HomeWall& wall);

}  // namespace crossnav::homes
