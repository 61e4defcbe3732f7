// SPDX-License-Identifier: MIT
// Where the goal of a search may stand: probabilities of the patches of a known house.
#pragma once

#include <map>

#include "crossnav/agent/state.h"

namespace crossnav::agent {

inline constexpr double kFurnitureTop_m = 0.25;  // chosen: lowest top of furniture

/// Odds of the rooms of the graph. They go by the area that the goal may stand on: a vase is in
/// rooms with tables.
std::map<int, double> OddsOf(const World& world, const GoalState& goal);

/// Probability of each patch, in sum 1, by the odds of the rooms; without odds all ground is alike.
std::map<geometry::VoxelKey, double> SharesOf(const World& world, const GoalState& goal,
                                              const std::map<int, double>& odds);

}  // namespace crossnav::agent
