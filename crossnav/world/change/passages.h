// SPDX-License-Identifier: MIT
// Narrow places of a house at which a way can be barred: doorways and passages between rooms, and
// flights. World frame, metres.
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
  Board board;   ///< across it, as wide as it is; its height is the caller's
  int leaf = 0;  ///< instance of a door that hangs in it; 0 = none
  bool is_flight = false;
};

/// Doorways and passages up to 1.6 m wide, in the order of their rooms, then flights.
std::vector<Passage> PassagesOf(const sim::Scene& scene, const sim::RayCaster& caster,
                                const HouseView& view);

/// Rooms that are cut off from the rest without `passages[index]`, as far as rooms, passages and
/// flights tell: the smaller side, by area; none where a way leads around.
std::vector<int> CutOffWithout(const std::vector<Passage>& passages, std::size_t index,
                               const HouseView& view);

}  // namespace crossnav::world
