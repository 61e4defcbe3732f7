// SPDX-License-Identifier: MIT
// Staircases of a home as connections between storeys: a test whether they can be climbed, and
// plain flights as substitutes for models that cannot (ladders, spirals with treads of half a
// metre, drawings in a box).
#pragma once

#include <optional>
#include <vector>

#include "crossnav/homes/home_builder.h"
#include "crossnav/sim/navmesh/navmesh.h"

namespace crossnav::homes {

/// A staircase that cuts through the floor above it.
struct Flight {
  std::size_t piece = 0;         ///< index in HomePlan::pieces
  double foot_m = 0, top_m = 0;  ///< heights of the connected floors
};

/// Staircases with a floor above them, in the order of the plan.
std::vector<Flight> FlightsOf(const HomePlan& plan);

/// Whether the navmesh of the scene around a staircase connects its foot to the floor above.
Result<bool> IsClimbable(const sim::Scene& scene, const HomePlan& plan, const Flight& flight,
                         const sim::NavMeshSettings& settings);

/// Flights within the piece's box, in its frame, the likeliest first: straight flights in the four
/// directions (first the direction in which `model` rises, if given), then spirals. Flights that
/// are too steep to walk are omitted.
std::vector<world::NamedObj> PlainFlights(const HomePiece& piece, double rise_m,
                                          const world::NamedObj* model);

/// Finds substitutes for staircases of `plan` that cannot be climbed, and adds them to `given`;
/// `notes` lists replaced and unsolved staircases.
Result<Substitutes> FixFlights(const HomePlan& plan, ModelStore& models,
                               const sim::NavMeshSettings& settings,
                               std::vector<std::string>& notes, Substitutes given = {});

}  // namespace crossnav::homes
