// SPDX-License-Identifier: MIT
// A floor from above with the names of its rooms, if known, and its goal objects in the colours of
// their categories.
#pragma once

#include "crossnav/sim/sensing/picture.h"
#include "crossnav/world/house/house_file.h"

namespace crossnav::app {

/// Floor `floor` of the navmesh; `rooms` may be empty.
RgbImage DrawFloorPlan(const sim::Scene& scene, const sim::RayCaster& caster,
                       const sim::NavMesh& navmesh, int floor, double px_per_m,
                       const std::vector<world::HouseRoom>& rooms);

}  // namespace crossnav::app
