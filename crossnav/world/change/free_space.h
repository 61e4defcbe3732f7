// SPDX-License-Identifier: MIT
// Tests by single rays whether a box of a scene is empty except for one object. World frame,
// metres.
#pragma once

#include <functional>

#include "crossnav/core/box.h"
#include "crossnav/sim/render/ray_caster.h"

namespace crossnav::world {

/// Footprint and height of an object at a place, and its permitted supports.
struct FreeQuestion {
  Box3 box;     ///< its lower side lies on the carrying surface
  int but = 0;  ///< ignored instance: the object itself, while it is in the scene
  std::function<bool(int instance)> may_carry;
};

/// Whether permitted supports lie below the whole box, at its lower side, and the box with a small
/// margin is empty.
bool IsFree(const sim::RayCaster& caster, const FreeQuestion& question);

/// Distance to the first surface of an instance other than `but`; `max_m` without one.
double FreeLength(const sim::RayCaster& caster, const Vector3d& p_world, const Vector3d& direction,
                  int but, double max_m);

}  // namespace crossnav::world
