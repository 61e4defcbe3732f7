// SPDX-License-Identifier: MIT
// What people leave lying about, after a plan was furnished: things on floors, small plants on
// tops, things that half hide a goal object. Doors, stairs and their walkways stay free.
#pragma once

#include "crossnav/core/rng.h"
#include "crossnav/world/furniture/furniture_source.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

struct LivedIn {
  double clutter_chance = 0;      ///< of a room: things on its floor
  double small_goal_chance = 0;   ///< of a top: a small plant on it
  double hidden_goal_chance = 0;  ///< of a goal object: something before it
};

void LiveIn(HousePlan& plan, const LivedIn& chances, const FurnitureSource& source, Rng& rng);

}  // namespace crossnav::world
