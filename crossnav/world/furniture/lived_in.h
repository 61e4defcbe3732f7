// SPDX-License-Identifier: MIT
// Clutter of everyday life, added to a furnished plan: objects on floors, small plants on tops,
// objects that half hide a goal object. Doors, stairs and their walkways stay free.
#pragma once

#include "crossnav/core/rng.h"
#include "crossnav/world/furniture/furniture_source.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

struct LivedIn {
  double clutter_chance = 0;      ///< of a room: objects on its floor
  double small_goal_chance = 0;   ///< of a top: a small plant on it
  double hidden_goal_chance = 0;  ///< of a goal object: an object before it
  bool has_odd_pieces = false;    ///< more furniture at any angle, in rows, on walls
};

void LiveIn(HousePlan& plan, const LivedIn& chances, const FurnitureSource& source, Rng& rng);

}  // namespace crossnav::world
