// SPDX-License-Identifier: MIT
// Furnishes the rooms of a home by their names, around what is drawn in them already.
// Deterministic.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "crossnav/homes/home_plan.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/furniture/furniture_source.h"

namespace crossnav::homes {

/// Adds to `plan.furnishing`. `scene` is the home as it is built. Doors and what leads through a
/// room stay open; `notes` says which rooms stay as they are.
void FurnishHome(HomePlan& plan, const sim::Scene& scene, std::uint64_t seed,
                 const world::FurnitureSource& source, std::vector<std::string>& notes);

}  // namespace crossnav::homes
