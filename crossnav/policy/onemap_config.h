// SPDX-License-Identifier: MIT
// Settings of the baseline OneMap (policy.profile = onemap; docs/onemap.md). Its paper names the
// quantities; the values are chosen here, in units that do not depend on the resolution.
#pragma once

#include "crossnav/core/setting.h"

namespace crossnav::policy {

struct OneMapConfig {
  double explored_confidence = 1.0;  // chosen: two frames from 3 m, four from 4 m
  double min_unexplored_m2 = 1.0;    // chosen: less behind a frontier is a corner under a table
  double frontier_depth_m = 2.0;     // chosen: how far behind a frontier its score is taken from
  double peak_window_m = 0.5;        // chosen: a peak is the largest within half a metre
  double cluster_share = 0.8;        // chosen: of a peak, down to which its cluster grows
  double keep_score = 0.01;          // chosen: a goal is kept while its score falls by less
  double same_goal_m = 0.5;          // chosen: goals within this distance are the same goal
  double consensus_quantile = 0.95;  // chosen: of the similarity, for detections to be believed
  double consensus_reach_m = 0.3;    // chosen: blur of the map
  double replace_factor = 1.1;       // chosen: by which another detection must answer better
  int stuck_steps = 10;              // chosen: at a goal that does not go away
};

template <class V>
void Visit(V& visit, OneMapConfig& c) {
  visit(CROSSNAV_SETTING(c, explored_confidence), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, min_unexplored_m2), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, frontier_depth_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, peak_window_m), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, cluster_share), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, keep_score), 0.0, 2.0);
  visit(CROSSNAV_SETTING(c, same_goal_m), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, consensus_quantile), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, consensus_reach_m), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, replace_factor), 1.0, 10.0);
  visit(CROSSNAV_SETTING(c, stuck_steps), 1, 1000);
}

}  // namespace crossnav::policy
