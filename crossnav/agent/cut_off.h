// SPDX-License-Identifier: MIT
// Places that the map knows and no path reaches: "cut off" is not "explored". World frame.
#pragma once

#include <string>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

struct CutOff {
  int levels = 0;         ///< that the agent stood on
  int flights = 0;        ///< seen or walked, with an end that is cut off
  int places = 0;         ///< remembered places that answer the goal
  double ground_m2 = 0;   ///< ground at the height of a level, as far as it is more than corners
  double reached_m2 = 0;  ///< ground that is not cut off, of any height
  bool IsEmpty() const { return levels + flights + places == 0 && ground_m2 == 0; }
};

/// By a search over all ground that can be reached under the planner rules in force.
CutOff FindCutOff(const Situation& now);

/// "1 level, 2 flights, 3.4 m2 of ground"; "nothing" where it is empty.
std::string Describe(const CutOff& cut_off);

}  // namespace crossnav::agent
