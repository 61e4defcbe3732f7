// SPDX-License-Identifier: MIT
// The progress line of an evaluation: how episodes ended so far, rate, remaining time.
#pragma once

#include <map>
#include <string>

#include "console.h"
#include "crossnav/bench/episode_record.h"

namespace crossnav::app {

class EvalProgress {
 public:
  EvalProgress(Console& console, int episodes);
  void Add(const bench::EpisodeRecord& record);

 private:
  Console& console_;
  int episodes_, done_ = 0;
  double start_ms_;
  std::map<std::string, int> outcomes_;
};

/// "2 h 05 min", "3 min 20 s", "45 s".
std::string DurationText(double seconds);

}  // namespace crossnav::app
