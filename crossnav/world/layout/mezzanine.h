// SPDX-License-Identifier: MIT
// A platform in a room of double height, railed towards the void. Access: from the hall of its
// level, or by a steep stair from the room below. Canonical frame.
#pragma once

#include "crossnav/core/rng.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// A void over a room.
struct VoidPlace {
  int void_room = -1;  ///< shrinks to the area beside the platform
  int below_room = -1;
  bool is_north = true;  ///< side of the corridor
  double slab_m = 0.25;
};

struct Mezzanine {
  int room = -1;  ///< added to the plan; -1 = the void is too small
  bool has_own_stair = false;
};

Mezzanine AddMezzanine(HousePlan& plan, const VoidPlace& place, Rng& rng);

}  // namespace crossnav::world
