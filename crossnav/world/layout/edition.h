// SPDX-License-Identifier: MIT
// Distributions of an edition of the generator. Edition 1 draws the same plans for ever, because
// named benchmarks use it. Edition 2 adds shapes of real buildings. A chance of 0 draws no random
// number, so that an ingredient of a later edition changes no house of an earlier edition.
#pragma once

#include <cstdint>

#include "crossnav/core/rng.h"

namespace crossnav::world {

struct Range {
  double lo = 0, hi = 0;

  double Draw(Rng& rng) const { return rng.Uniform(lo, hi); }
};

struct Edition {
  int number = 1;
  int max_attempts = 12;  ///< plans tried; chosen: more than half of them pass (`world stats`)
  std::uintmax_t most_bytes = 40'000'000;  ///< chosen: of the files of a house
  bool has_wide_stairs = false;   ///< stairs of every steepness, with half turns of winders
  double attic_chance = 0;        ///< chance of a separate stair to the top level
  Range door_m{0.80, 0.95};       ///< clear width
  Range ajar_deg{75, 75};         ///< of a leaf that is neither open nor closed
  double threshold_chance = 0;    ///< of a door
  double round_chance = 0;        ///< of a room: round corners or columns
  double sloping_chance = 0;      ///< of the top level of a house: a roof with slopes
  double mezzanine_chance = 0;    ///< of a room of double height
  double open_plan_chance = 0;    ///< of a level: rooms without walls between them
  double clutter_chance = 0;      ///< of a room: objects on its floor
  double small_goal_chance = 0;   ///< of a top: a small plant on it
  double hidden_goal_chance = 0;  ///< of a goal object: an object before it
  double office_chance = 0;       ///< of a building that may be a house or an office
};

inline constexpr int kEditions = 2;

/// `number` 1 to kEditions.
const Edition& EditionOf(int number);

/// False, without drawing a number, if the edition lacks the ingredient.
inline bool Draws(double chance, Rng& rng) {
  return chance > 0 && rng.Chance(chance);
}

}  // namespace crossnav::world
