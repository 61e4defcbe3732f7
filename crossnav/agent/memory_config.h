// SPDX-License-Identifier: MIT
// What a loaded memory is to the agent: believed as it stands, or revised by what is seen.
#pragma once

#include <string>

namespace crossnav::agent {

struct MemoryConfig {
  /// keep | revise: revise acts where a memory was loaded; it drops places that were seen without
  /// their object, searches where the object may have gone, and clears what is seen through.
  std::string mode = "keep";
  double absent_from = 0.85;  // chosen: odds of absence at which a search is given up
  double least_worth = 0.15;  // chosen: of ground in the least likely room, as share of the best
};

template <class V>
void Visit(V& visit, MemoryConfig& c) {
  visit("mode", c.mode, {"keep", "revise"});
  visit("absent_from", c.absent_from, 0.0, 1.0);
  visit("least_worth", c.least_worth, 0.001, 1.0);
}

}  // namespace crossnav::agent
