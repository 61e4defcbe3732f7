// SPDX-License-Identifier: MIT
// Backs of one-sided faces, for renderers that show the front of a triangle alone: Habitat-Sim's,
// whatever the material says of two sides.
#pragma once

#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// The scene with each triangle once more in the opposite winding, for those instances that are not
/// closed or do not face outward: leaves, curtains, panes.
sim::Scene WithBacks(sim::Scene scene);

}  // namespace crossnav::world
