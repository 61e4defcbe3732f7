// SPDX-License-Identifier: MIT
// One change of a house overnight.
#pragma once

#include <optional>

#include "crossnav/core/rng.h"
#include "crossnav/world/change/house_days.h"

namespace crossnav::world {

struct ChangeWish {
  const HouseView& evening;
  const sim::NavMeshSettings& navmesh;
  ChangeKind kind;
};

/// Makes one change of the kind and notes it in the day's list; objects of which the house has one
/// only come first, so that a search for them is a search for the change. False where the house has
/// no place for it. Error: no navmesh.
Result<bool> ChangeOnce(const ChangeWish& wish, HouseDay& day, Rng& rng);

/// `scene` of a day without the boards that bar its ways: leaves hang as on the evening before.
sim::Scene WithoutBars(const sim::Scene& scene, const sim::Scene& evening, const DayChanges& list);

}  // namespace crossnav::world
