// SPDX-License-Identifier: MIT
// The gate of a changed house: what the generator asks of a house (house/house_gate.h), asked of a
// scene, so that it holds for imported homes, too. Judged against the first day.
#pragma once

#include "crossnav/core/camera.h"
#include "crossnav/world/change/changes.h"
#include "crossnav/world/change/house_view.h"

namespace crossnav::world {

/// Error with the first reason: a floor or room that was usable on the first day is gone or cut
/// off, fewer than five categories (or than the first day had), a category or a changed object that
/// cannot be viewed from a place that the start reaches.
Result<void> CheckDay(const HouseView& first, const sim::Scene& first_scene,
                      const sim::Scene& scene, const sim::NavMesh& navmesh,
                      const std::vector<Change>& changes);

}  // namespace crossnav::world
