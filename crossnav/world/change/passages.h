// SPDX-License-Identifier: MIT
// Narrow places of a house that can be barred: doorways and passages between rooms, and flights.
// World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/world/change/house_view.h"
#include "crossnav/world/change/scene_edit.h"

namespace crossnav::world {

/// A place to bar, as a board across it.
struct Passage {
  int room_a = -1, room_b = -1;  ///< indices of rooms; of a flight: where it begins and ends
  Vector3d a_world = Vector3d::Zero(), b_world = Vector3d::Zero();  ///< ground on either side
  Board board;   ///< across the whole width; the caller sets the height
  int leaf = 0;  ///< instance of its door; 0 = none
  bool is_flight = false;
};

/// Doorways and passages up to 1.6 m wide, in the order of their rooms, then flights.
std::vector<Passage> PassagesOf(const sim::Scene& scene, const sim::RayCaster& caster,
                                const HouseView& view);

/// Rooms cut off by a bar at `passages[index]`, in the graph of rooms, passages and flights: the
/// side of smaller area; empty if a detour exists.
std::vector<int> CutOffWithout(const std::vector<Passage>& passages, std::size_t index,
                               const HouseView& view);

}  // namespace crossnav::world
