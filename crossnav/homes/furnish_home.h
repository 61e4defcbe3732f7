// SPDX-License-Identifier: MIT
// Furnishes the rooms of a home by their names, around the existing pieces. Deterministic.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "crossnav/homes/home_plan.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/furniture/furniture_source.h"

namespace crossnav::homes {

/// Adds to `plan.furnishing`. `scene` is the built home. Doors and passages through a room stay
/// open; `notes` lists the rooms without changes.
void FurnishHome(HomePlan& plan, const sim::Scene& scene, std::uint64_t seed,
                 const world::FurnitureSource& source, std::vector<std::string>& notes);

}  // namespace crossnav::homes
