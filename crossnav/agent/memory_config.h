// SPDX-License-Identifier: MIT
// Trust in a loaded memory: kept as saved, or revised by observations.
#pragma once

#include <string>

namespace crossnav::agent {

struct MemoryConfig {
  /// keep | revise: revise acts where a memory was loaded; it drops places that were seen without
  /// their object, searches where the object may have gone, and clears what is seen through.
  std::string mode = "keep";
  double absent_from = 0.85;  // chosen: odds of absence at which a search is given up
  /// Actions for a goal before a search is given up because the rest costs much for its
  /// probability; chosen: a third of eval.action_budget, so that most of it is left.
  int search_actions = 400;
};

template <class V>
void Visit(V& visit, MemoryConfig& c) {
  visit("mode", c.mode, {"keep", "revise"});
  visit("absent_from", c.absent_from, 0.0, 1.0);
  visit("search_actions", c.search_actions, 0, 1000000);
}

}  // namespace crossnav::agent
