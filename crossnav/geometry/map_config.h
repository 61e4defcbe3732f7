// SPDX-License-Identifier: MIT
// Settings of the geometric map. Defaults: tab:supp_configuration where the paper has the value.
#pragma once

#include <string>

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
};

template <class V>
void Visit(V& visit, MapConfig& c) {
  visit("voxel_m", c.voxel_m, 0.02, 0.5);
  visit("extent_xy_m", c.extent_xy_m, 1.0, 10000.0);
  visit("extent_z_m", c.extent_z_m, 1.0, 10000.0);
  visit("clip_to_extent", c.clip_to_extent);
  visit("inflation_m", c.inflation_m, 0.0, 2.0);
  visit("support_depth_m", c.support_depth_m, 0.0, 3.0);
  visit("max_climb_m", c.max_climb_m, 0.0, 1.0);
  visit("agent_height_m", c.agent_height_m, 0.1, 3.0);
  visit("agent_radius_m", c.agent_radius_m, 0.0, 2.0);
  visit("depth_min_m", c.depth_min_m, 0.0, 100.0);
  visit("depth_max_m", c.depth_max_m, 0.1, 1000.0);
  visit("rays", c.rays, {"fast", "exact"});
  visit("clearing", c.clearing, {"never", "evidence"});
  visit("min_hits", c.min_hits, 1, 1000);
  visit("hit_ratio", c.hit_ratio, 0.0, 1.0);
  visit("max_hits", c.max_hits, 1, 1000);
}

}  // namespace crossnav::geometry
