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
  bool only_by_category = false;  ///< of DaysOptions
};

/// Makes one change of the kind and adds it to the day's list. Unique objects come first, so that a
/// search for the object tests the change. False if the house has no place for it. Error: no
/// navmesh.
Result<bool> ChangeOnce(const ChangeWish& wish, HouseDay& day, Rng& rng);

/// `scene` of a day without its boards; leaves hang as on the previous evening.
sim::Scene WithoutBars(const sim::Scene& scene, const sim::Scene& evening, const DayChanges& list);

}  // namespace crossnav::world
