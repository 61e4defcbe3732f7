// SPDX-License-Identifier: MIT
// Finer triangles for baked light and scan faults. Surfaces keep their shape; texture coordinates
// and vertex colours are interpolated.
#pragma once

#include <functional>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// Splits triangles until no edge is longer than `max_edge_m`. Triangles of at most `min_area_m2`
/// stay whole, because long strips would give many.
void Subdivide(sim::TriangleMesh& mesh, double max_edge_m, double min_area_m2 = 0);

/// Splits only where `wants(triangle)`; each half is tested again.
void SubdivideWhere(sim::TriangleMesh& mesh, double max_edge_m,
                    const std::function<bool(std::size_t)>& wants);

}  // namespace crossnav::world
