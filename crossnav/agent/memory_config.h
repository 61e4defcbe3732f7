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
};

template <class V>
void Visit(V& visit, MemoryConfig& c) {
  visit("mode", c.mode, {"keep", "revise"});
  visit("absent_from", c.absent_from, 0.0, 1.0);
}

}  // namespace crossnav::agent
