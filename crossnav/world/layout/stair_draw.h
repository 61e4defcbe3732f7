// SPDX-License-Identifier: MIT
// Draws the kind and the dimensions of a stair: comfortable flights by Blondel's rule in edition 1,
// the full range of existing steepness in edition 2. Metres.
#pragma once

#include <optional>

#include "crossnav/world/layout/edition.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {

/// Ranges of a stair's dimensions.
struct StairRange {
  Range riser_m, tread_m, width_m;
};

enum class StairUse { kMain, kCellar, kAttic };

/// Minimum and maximum floor-to-floor height of the storeys that a stair serves, all with the same
/// number of risers.
struct Storeys {
  double least_m = 2.8, most_m = 2.8;
  double slab_m = 0.25;
};

StairKind DrawStairKind(const Edition& edition, StairUse use, Rng& rng);

/// nullopt if no number of risers keeps to the edition's limits on all storeys.
std::optional<StairParams> DrawStair(const Edition& edition, StairKind kind, const Storeys& storeys,
                                     Rng& rng);

/// Ranges of edition 2; a riser stays below the benchmark's climb limit of 0.30 m.
StairRange DrawStairRange(StairKind kind, Rng& rng);

/// Number of risers nearest to `wanted_riser_m` with the largest riser within `limit_m`, or
/// nullopt.
std::optional<int> RisersFor(const Storeys& storeys, double wanted_riser_m, const Range& limit_m);

/// Draws body and railings; common to all editions.
void DrawStairBody(StairParams& stair, Rng& rng);

}  // namespace crossnav::world
