// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/edition.h"

#include "crossnav/core/check.h"

namespace crossnav::world {
namespace {

Edition Second() {
  Edition e;
  e.number = 2;
  e.max_attempts = 200;        // chosen: one in ten plans of an office of 1,000 m2 has its doors
  e.most_bytes = 160'000'000;  // chosen: as the largest scans of HM3D; 1,000 m2 with 100 rooms

  e.has_wide_stairs = true;
  e.attic_chance = 0.35;
  e.door_m = {0.65, 0.95};
  e.ajar_deg = {40, 80};
  e.threshold_chance = 0.3;
  e.round_chance = 0.2;
  e.sloping_chance = 0.35;
  e.mezzanine_chance = 0.7;
  e.open_plan_chance = 0.4;
  e.clutter_chance = 0.6;
  e.small_goal_chance = 0.25;
  e.hidden_goal_chance = 0.2;
  e.office_chance = 0.12;
  return e;
}

}  // namespace

const Edition& EditionOf(int number) {
  static const Edition editions[kEditions] = {Edition(), Second()};
  CROSSNAV_CHECK(number >= 1 && number <= kEditions, "no such edition of the generator");
  return editions[number - 1];
}

}  // namespace crossnav::world
