// SPDX-License-Identifier: MIT
// Stairs with a house's dimensions. Each kind is made in its own frame: the first riser stands on
// x = 0, the first flight climbs towards +x, y = 0 is its middle, z = 0 is the lower floor. Moved()
// puts it into the house by quarter turns.
#pragma once

#include "crossnav/world/plan.h"

namespace crossnav::world {

struct StairParams {
  StairKind kind = StairKind::kStraight;
  StairBody body = StairBody::kSolid;
  double rise_m = 2.8;  ///< floor to floor
  int risers = 16;
  double tread_m = 0.28;
  double width_m = 1.0;
  bool turns_left = true;  ///< L, U, winder and spiral
  bool rail_left = false;  ///< seen when climbing; false where a wall stands
  bool rail_right = false;
  int rail_style = 0;
  double slab_m = 0.3;  ///< ceiling to floor above, decides where headroom ends
};

/// The stair in its own frame.
Stair MakeStair(const StairParams& params);

/// `stair` turned by `quarter_turns` counter-clockwise and moved so that its origin is `p_world`.
Stair Moved(Stair stair, const Vector3d& p_world, int quarter_turns);

Stair MakeStraightStair(const StairParams& params);

}  // namespace crossnav::world
