// SPDX-License-Identifier: MIT
// What happens to a finished scene before it is written: finer triangles, ambient occlusion baked
// into vertex colours, and the damage of a real scan. All of it is seeded and deterministic.
#pragma once

#include <cstdint>

#include "crossnav/sim/scene.h"

namespace crossnav::world {

/// Splits triangles until no edge is longer than `max_edge_m`; surfaces keep their shape.
void Subdivide(sim::TriangleMesh& mesh, double max_edge_m);

/// Darkens vertices by what is close in front of them (within 1.2 m). About 10 us a vertex.
void BakeAmbientOcclusion(sim::Scene& scene);

struct ScanDamage {
  std::uint64_t seed = 1;
  double holes_per_m2 = 0.03;  // chosen by eye against published pictures of HM3D scans
  double hole_radius_m = 0.18;
  double noise_m = 0.006;  // of vertices
  int floaters = 40;       // loose fragments
};

/// Holes in surfaces (never in ground that one walks on), noise on vertices, floating fragments.
/// Instances keep their names; fragments belong to none.
void DamageAsScan(sim::Scene& scene, const ScanDamage& damage);

}  // namespace crossnav::world
