// SPDX-License-Identifier: MIT
// Quality gate of generated houses: requirements of a house before it is written.
#pragma once

#include <cstdint>
#include <optional>

#include "crossnav/core/result.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// First violated requirement: floors that are not connected, a room that cannot be reached or is
/// mostly cut off, fewer than five of the six categories, furniture that overlaps furniture or a
/// doorway. BlockedRoom: index of the first room without walkable ground or mostly cut off, or
/// nullopt.
std::optional<int> BlockedRoom(const HousePlan& plan, const sim::NavMesh& navmesh);

/// Limit of the files of a house with `built_m2` on all floors. Up to the largest area that is
/// drawn without being asked for it is 40 MB: with another limit another plan of a seed would
/// pass, and named sets would have other houses.
std::uintmax_t MostBytesOf(int edition, double built_m2);

Result<void> CheckHouse(const HousePlan& plan, const sim::Scene& scene,
                        const sim::NavMesh& navmesh);

}  // namespace crossnav::world
