// SPDX-License-Identifier: MIT
// A home's plan and models -> a scene in the world frame.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "crossnav/homes/home_plan.h"
#include "crossnav/homes/model_store.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::homes {

/// Substitute models by index of the piece, in the piece's own frame.
using Substitutes = std::map<std::size_t, world::NamedObj>;

/// Whether the piece is a door between two rooms.
bool IsInnerDoor(const HomePlan& plan, const HomePiece& piece);

/// Deviations from the plan are added to `notes`.
sim::Scene BuildHome(const HomePlan& plan, ModelStore& models, const Substitutes& substitutes,
                     std::vector<std::string>& notes);

}  // namespace crossnav::homes
