// SPDX-License-Identifier: MIT
// Simplification of models with more triangles than a scene needs.
#pragma once

#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

/// Reduces triangles material by material, so that seams stay. Some models stop far above `budget`.
void Simplify(ObjectModel& model, int budget);

/// Drops unused vertices.
void Compact(ObjectModel& model);

}  // namespace crossnav::world
