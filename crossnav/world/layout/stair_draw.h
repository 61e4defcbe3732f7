// SPDX-License-Identifier: MIT
// Draws the kind and the dimensions of a stair: comfortable flights by Blondel's rule in edition 1,
// every steepness that people build in edition 2. Metres.
#pragma once

#include <optional>

#include "crossnav/world/layout/edition.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {

/// What a stair's dimensions are drawn from.
struct StairRange {
  Range riser_m, tread_m, width_m;
};

enum class StairUse { kMain, kCellar, kAttic };

/// Least and largest floor to floor of the storeys that a stair serves, all with as many risers.
struct Storeys {
  double least_m = 2.8, most_m = 2.8;
  double slab_m = 0.25;
};

StairKind DrawStairKind(const Edition& edition, StairUse use, Rng& rng);

/// nullopt where no number of risers keeps to the edition's limits on all storeys.
std::optional<StairParams> DrawStair(const Edition& edition, StairKind kind, const Storeys& storeys,
                                     Rng& rng);

/// Ranges of edition 2; a riser stays below the climb limit of 0.30 m that the benchmark sets.
StairRange DrawStairRange(StairKind kind, Rng& rng);

/// Number of risers nearest to `wanted_riser_m` whose largest stays within `limit_m`, or nullopt.
std::optional<int> RisersFor(const Storeys& storeys, double wanted_riser_m, const Range& limit_m);

/// Body and railings, as every edition draws them.
void DrawStairBody(StairParams& stair, Rng& rng);

}  // namespace crossnav::world
