// SPDX-License-Identifier: MIT
// Stairs of any dimensions (layout/stair_draw.h draws the dimensions of houses). Each kind is made
// in its own frame and moved into the house by quarter turns. Metres, z up.
#pragma once

#include <string_view>

#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

struct StairParams {
  StairKind kind = StairKind::kStraight;
  StairBody body = StairBody::kSolid;
  double rise_m = 2.8;  ///< floor to floor
  int risers = 16;
  double tread_m = 0.28;
  double width_m = 1.0;
  double landing_m = 0;        ///< length of a landing; 0 = about as long as the flight is wide
  double slab_m = 0.3;         ///< ceiling to floor above, determines the end of headroom
  double approach_m = 0.3;     ///< free ground before the first riser of L, U, winder and spiral
  bool has_left_rail = false;  ///< straight flights, seen when climbing; false beside a wall
  bool has_right_rail = true;
  int rail_style = 0;
  bool is_continued = false;  ///< the next stair starts above this one
};

/// A stair in a rectangular shaft [0, width] x [0, depth] with the edge y = 0 on a corridor; walls
/// may stand on the other three edges. z = 0 is the lower floor.
struct StairBlock {
  Stair stair;
  double width_m = 0, depth_m = 0;
  double entry_x0 = 0, entry_x1 = 0;  ///< part of the edge y = 0 with the entry from below
  double exit_x0 = 0, exit_x1 = 0;    ///< part of the edge y = 0 with the exit above
};

StairBlock MakeStairBlock(const StairParams& params);

/// A straight flight in its own frame: the first riser is on x = 0, the flight climbs towards +x, y
/// = 0 is its middle. `landing_after` > 0 puts a landing after that number of risers.
Stair MakeStraightStair(const StairParams& params, int landing_after = 0);

StairBlock MakeUStair(const StairParams& params);
StairBlock MakeHalfWinderStair(const StairParams& params);  ///< a U whose half turn has treads
StairBlock MakeLStair(const StairParams& params);  ///< with winders for kinds that have them
StairBlock MakeSpiralStair(const StairParams& params);

/// Steps between floors of one storey, like a straight flight without a void.
Stair MakeSteps(double rise_m, int risers, double tread_m, double width_m);

/// `stair` turned by `quarter_turns` counter-clockwise and moved so that its origin is `p_world`.
Stair Moved(Stair stair, const Vector3d& p_world, int quarter_turns);

/// As Moved, but first mirrored at x = 0.
Stair Mirrored(Stair stair);

/// Number of the first treads with enough height below the ceiling, so that no void is needed.
int TreadsUnderCeiling(const StairParams& params);

/// Railings along the edges of all voids, except at walls and at arrivals and departures of stairs.
void RailVoids(HousePlan& plan, int style);

/// "straight", "straight with landing", ...
std::string_view NameOf(StairKind kind);

}  // namespace crossnav::world
