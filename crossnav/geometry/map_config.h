// SPDX-License-Identifier: MIT
// Settings of the geometric map. Defaults: tab:supp_configuration where the paper has the value.
#pragma once

#include <string>

#include "crossnav/core/setting.h"

namespace crossnav::geometry {

struct MapConfig {
  double voxel_m = 0.10;
  double extent_xy_m = 60;  ///< the paper's box about the first camera; applied only where
                            ///< clip_to_extent is set or policy.profile = paper
  double extent_z_m = 60;   ///< about +-30 m
  bool clip_to_extent = false;
  double inflation_m = 0.20;
  double support_depth_m = 0.40;
  double max_climb_m = 0.30;       ///< surfaces up to this above the support do not inflate
  double agent_height_m = 1.50;    ///< surfaces up to this above the support do
  double agent_radius_m = 0.10;    ///< of the agent's own free cylinder
  double depth_min_m = 0.1;        // chosen: sensor limits of common RGB-D cameras
  double depth_max_m = 10.0;       // chosen: likewise
  std::string rays = "fast";       ///< exact | fast
  std::string clearing = "never";  ///< never | evidence
  int min_hits = 2;                // chosen: a single stray return is not a wall
  double hit_ratio = 0.25;         // chosen: occupied while hits >= ratio x passes
  int max_hits = 6;                // chosen: five frames that look through an object remove it
  int min_neighbours = 2;          // chosen: of a reading that confirm it, or it is a flying pixel;
                                   // clearing = evidence
};

template <class V>
void Visit(V& visit, MapConfig& c) {
  visit(CROSSNAV_SETTING(c, voxel_m), 0.02, 0.5);
  visit(CROSSNAV_SETTING(c, extent_xy_m), 1.0, 10000.0);
  visit(CROSSNAV_SETTING(c, extent_z_m), 1.0, 10000.0);
  visit(CROSSNAV_SETTING(c, clip_to_extent));
  visit(CROSSNAV_SETTING(c, inflation_m), 0.0, 2.0);
  visit(CROSSNAV_SETTING(c, support_depth_m), 0.0, 3.0);
  visit(CROSSNAV_SETTING(c, max_climb_m), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, agent_height_m), 0.1, 3.0);
  visit(CROSSNAV_SETTING(c, agent_radius_m), 0.0, 2.0);
  visit(CROSSNAV_SETTING(c, depth_min_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, depth_max_m), 0.1, 1000.0);
  visit(CROSSNAV_SETTING(c, rays), {"fast", "exact"});
  visit(CROSSNAV_SETTING(c, clearing), {"never", "evidence"});
  visit(CROSSNAV_SETTING(c, min_hits), 1, 1000);
  visit(CROSSNAV_SETTING(c, hit_ratio), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, max_hits), 1, 1000);
  visit(CROSSNAV_SETTING(c, min_neighbours), 0, 8);
}

}  // namespace crossnav::geometry
