// SPDX-License-Identifier: MIT
// Houses whose floors look alike: the hard case of who wakes up in one and does not know where. The
// upper floor has the rooms, walls and doors of the lower one, and its furniture or its own; the
// stair and the hole above it are all that tells empty floors apart.
#pragma once

#include "crossnav/core/result.h"
#include "crossnav/core/rng.h"
#include "crossnav/world/furniture/furniture_source.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

enum class TwinFurniture { kSame, kOwn };

/// `plan` with its upper floor replaced. Error: a plan of other than two levels, or with rooms that
/// are open to another floor.
Result<HousePlan> TwinFloors(const HousePlan& plan, TwinFurniture furniture,
                             const FurnitureSource& source, Rng& rng);

}  // namespace crossnav::world
