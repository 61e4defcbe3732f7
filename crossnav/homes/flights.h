// SPDX-License-Identifier: MIT
// Staircases of a home as ways between storeys: whether one can climb them, and plain flights that
// stand in for models one cannot (ladders, spirals with half a metre of tread, drawings in a box).
#pragma once

#include <optional>
#include <vector>

#include "crossnav/homes/home_builder.h"
#include "crossnav/sim/navmesh/navmesh.h"

namespace crossnav::homes {

/// A staircase that cuts through the floor above it.
struct Flight {
  std::size_t piece = 0;         ///< index in HomePlan::pieces
  double foot_m = 0, top_m = 0;  ///< heights of the floors that it joins
};

/// Staircases with a floor above them, in the order of the plan.
std::vector<Flight> FlightsOf(const HomePlan& plan);

/// Whether the navmesh of the scene around a staircase leads from its foot to the floor above.
Result<bool> IsClimbable(const sim::Scene& scene, const HomePlan& plan, const Flight& flight,
                         const sim::NavMeshSettings& settings);

/// Flights of the piece's box, in its frame, the likeliest first: straight ones in the four
/// directions (first in which `model` rises, where there is one), then spirals. Those that would be
/// steeper than one can walk are left out.
std::vector<world::NamedObj> PlainFlights(const HomePiece& piece, double rise_m,
                                          const world::NamedObj* model);

/// Finds substitutes for the staircases of `plan` that cannot be climbed, and adds them to `given`;
/// `notes` says for which, and for which none was found.
Result<Substitutes> FixFlights(const HomePlan& plan, ModelStore& models,
                               const sim::NavMeshSettings& settings,
                               std::vector<std::string>& notes, Substitutes given = {});

}  // namespace crossnav::homes
