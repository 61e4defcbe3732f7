// SPDX-License-Identifier: MIT
// Faults of a real scan, applied to a clean scene: holes, noise, loose fragments, mirrors and panes
// without a surface, patches without a texture, objects cut off below the ceiling. Seeded and
// deterministic. Names and instances stay; walkable places stay walkable.
#pragma once

#include <cstdint>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

// All chosen by eye against published pictures of HM3D scans; a share of 0 switches a fault off.
struct ScanDamage {
  std::uint64_t seed = 1;
  double holes_per_m2 = 0.03;
  double hole_radius_m = 0.18;
  double noise_m = 0.006;  ///< of vertices
  int floaters = 40;       ///< loose fragments
  /// of mirrors: removed with the wall behind, because a scanner sees through
  double mirror_share = 0.8;
  double glass_share = 0.5;     ///< of windows: the pane is removed
  double blanks_per_m2 = 0.02;  ///< patches without a texture
  double blank_radius_m = 0.35;
  double cut_share = 0.4;  ///< of objects near a ceiling: the top is removed
};

void DamageAsScan(sim::Scene& scene, const ScanDamage& damage);

}  // namespace crossnav::world
