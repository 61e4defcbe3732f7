// SPDX-License-Identifier: MIT
// Trust in a loaded memory: kept as saved, or revised by observations.
#pragma once

#include <string>

namespace crossnav::agent {

struct MemoryConfig {
  /// keep | revise: revise acts where a memory was loaded; it drops places that were seen without
  /// their object, searches where the object may have gone, and clears what is seen through.
  std::string mode = "keep";
  /// Probability that the goal is gone from which a search goes on only at little cost.
  double absent_from = 0.7;  // chosen: a tenth of the probability is left to see
};

template <class V>
void Visit(V& visit, MemoryConfig& c) {
  visit("mode", c.mode, {"keep", "revise"});
  visit("absent_from", c.absent_from, 0.0, 1.0);
}

}  // namespace crossnav::agent
