// SPDX-License-Identifier: MIT
// Settings of a live run (docs/live.md).
#pragma once

#include "crossnav/core/setting.h"

namespace crossnav::serve {

struct ServeConfig {
  double period_s = 1.0;    // chosen: 0.25 m/s and 30 deg/s, within reach of small robots
  double watchdog_s = 3.0;  // chosen: an action, its picture and a slow step
};

template <class V>
void Visit(V& visit, ServeConfig& c) {
  visit(CROSSNAV_SETTING(c, period_s), 0.01, 60.0);
  visit(CROSSNAV_SETTING(c, watchdog_s), 0.02, 600.0);
}

}  // namespace crossnav::serve
