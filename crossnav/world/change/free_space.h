// SPDX-License-Identifier: MIT
// Whether a box of a scene is empty but for one object, asked with single rays. World frame,
// metres.
#pragma once

#include <functional>

#include "crossnav/core/box.h"
#include "crossnav/sim/render/ray_caster.h"

namespace crossnav::world {

/// Footprint and height of an object at a place, and what it may stand on.
struct FreeQuestion {
  Box3 box;     ///< its lower side lies on the carrying surface
  int but = 0;  ///< the object's own instance, where its triangles are still in the scene
  std::function<bool(int instance)> may_carry;
};

/// The surface below all of the box is at its lower side and may carry it, and nothing else is in
/// the box or in a small margin around it.
bool IsFree(const sim::RayCaster& caster, const FreeQuestion& question);

/// Distance to the first surface that is not of `but`; `max_m` where there is none.
double FreeLength(const sim::RayCaster& caster, const Vector3d& p_world, const Vector3d& direction,
                  int but, double max_m);

}  // namespace crossnav::world
