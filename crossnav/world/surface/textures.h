// SPDX-License-Identifier: MIT
// Procedural surface patterns of real size: planks, tiles, plaster, carpet, brick. The pictures are
// near white and multiply the surface's colour, so that one picture serves all colours. They tile
// without a seam.
#pragma once

#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// Picture of one repeat; empty for kPlain.
sim::Texture MakePattern(Pattern pattern, std::uint64_t seed);

/// Length of one repeat [m].
double PatternSize(Pattern pattern);

}  // namespace crossnav::world
