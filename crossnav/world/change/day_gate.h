// SPDX-License-Identifier: MIT
// Gate of a changed house: the generator's requirements (house/house_gate.h), checked on a scene,
// so that they apply to imported homes, too. The reference is the first day.
#pragma once

#include <set>
#include <utility>

#include "crossnav/core/camera.h"
#include "crossnav/world/change/changes.h"
#include "crossnav/world/change/house_view.h"

namespace crossnav::world {

/// `shut` rooms (floor, region) lie behind a door or barrier of the day and need not be reached.
using ShutRooms = std::set<std::pair<int, int>>;
struct JudgedDay {
  const sim::Scene& scene;
  const std::vector<Change>& changes;
  const ShutRooms& shut;
};
/// Error with the first reason: a floor or room that was usable on the first day is gone or cut
/// off, fewer than five categories (or than the first day had), a category that could be viewed on
/// the first day, or a changed object, that cannot be viewed from a place that the start reaches.
Result<void> CheckDay(const HouseView& first, const sim::Scene& first_scene, const JudgedDay& day,
                      const sim::NavMesh& navmesh);

/// Settings for a body that is wider by the room that a way must leave it.
sim::NavMeshSettings WithRoomToSpare(sim::NavMeshSettings settings);

/// Error if a room, not in `shut`, that such a body could reach on the first day cannot be reached
/// by it. `first_spare`, `spare`: navmeshes of the first day and of this one WithRoomToSpare.
Result<void> CheckWays(const HouseView& first, const sim::NavMesh& first_spare,
                       const sim::NavMesh& spare, const ShutRooms& shut);

}  // namespace crossnav::world
