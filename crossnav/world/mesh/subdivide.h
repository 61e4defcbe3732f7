// SPDX-License-Identifier: MIT
// Finer triangles, for light and damage that need them. Surfaces keep their shape; texture
// coordinates and vertex colours are interpolated.
#pragma once

#include <functional>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// Splits triangles until no edge is longer than `max_edge_m`. Triangles of at most `min_area_m2`
/// stay whole: long strips would give many.
void Subdivide(sim::TriangleMesh& mesh, double max_edge_m, double min_area_m2 = 0);

/// The same, only where `wants(triangle)`, which is asked again about each half.
void SubdivideWhere(sim::TriangleMesh& mesh, double max_edge_m,
                    const std::function<bool(std::size_t)>& wants);

}  // namespace crossnav::world
