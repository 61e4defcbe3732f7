// SPDX-License-Identifier: MIT
// Models with more triangles than a scene needs.
#pragma once

#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

/// Fewer triangles, material by material, so that seams stay. Some models stop far above `budget`.
void Simplify(ObjectModel& model, int budget);

/// Drops vertices that no triangle uses.
void Compact(ObjectModel& model);

}  // namespace crossnav::world
