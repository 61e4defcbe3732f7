// SPDX-License-Identifier: MIT
// Zones of a room that stay free: before doors and windows, around stairs, railings and blocks.
// World frame, metres.
#pragma once

#include <vector>

#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

struct RoomSpace {
  double floor_m = 0, ceiling_m = 0;
  Rect inner;  ///< of the first rectangle, without half walls and skirtings
  std::vector<Box3> keep_out;
};

RoomSpace SpaceOf(const HousePlan& plan, int room);

Box3 Solid(const Rect& r, double z0, double z1);

/// Overlap by more than kOverlapTolerance_m, or by more than a part of the thinner box: without
/// this a picture would fit anywhere.
bool Overlap(const Box3& a, const Box3& b);

}  // namespace crossnav::world
