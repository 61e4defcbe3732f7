// SPDX-License-Identifier: MIT
#pragma once

#include "crossnav/core/setting.h"

namespace crossnav::planner {

/// tab:supp_configuration, rows "Planner"; the type penalties are in geometry/voxel_states.h.
struct PlannerConfig {
  double stair_edge_radius_m = 1.0;
  double inflated_cost_factor = 2;
  double tight_cost_factor = 1.2;  // chosen: of profile full, in place of it: doors are tight
  double touch_cost_factor = 6;    // chosen: a detour of a metre around a spot of one voxel's width
  double high_step_cost = 2;  // chosen: [voxels] a step at the climb limit; stairs have lower ones
  double bridge_cost_factor = 2;  // chosen: as inflated space; across an unobserved tread
  // chosen: a storey's exploration, for a step down without a known path back up
  double one_way_m = 30;
  double doubtful_m = 3;        // chosen: a detour around a step that a relaxed rule allows
  int max_expansions = 400000;  // chosen: several times a 400 m2 two-floor house; 0 = no limit
};

template <class V>
void Visit(V& visit, PlannerConfig& c) {
  visit(CROSSNAV_SETTING(c, stair_edge_radius_m), 0.1, 5.0);
  visit(CROSSNAV_SETTING(c, inflated_cost_factor), 1.0, 100.0);
  visit(CROSSNAV_SETTING(c, tight_cost_factor), 1.0, 100.0);
  visit(CROSSNAV_SETTING(c, touch_cost_factor), 1.0, 1000.0);
  visit(CROSSNAV_SETTING(c, high_step_cost), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, bridge_cost_factor), 1.0, 1000.0);
  visit(CROSSNAV_SETTING(c, one_way_m), 0.0, 100000.0);
  visit(CROSSNAV_SETTING(c, doubtful_m), 0.0, 100000.0);
  visit(CROSSNAV_SETTING(c, max_expansions), 0, 2000000000);
}

}  // namespace crossnav::planner
