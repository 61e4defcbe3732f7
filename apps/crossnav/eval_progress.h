// SPDX-License-Identifier: MIT
// Progress lines of evaluations (endings of episodes so far, rate, remaining time) and of counted
// work.
#pragma once

#include <map>
#include <string>

#include "console.h"
#include "crossnav/evaluation/records/episode_record.h"

namespace crossnav::app {

class EvalProgress {
 public:
  EvalProgress(Console& console, int episodes);
  void Add(const evaluation::EpisodeRecord& record);

 private:
  Console& console_;
  int episodes_, done_ = 0;
  double start_ms_;
  std::map<std::string, int> outcomes_;
};

/// Progress of equal units of work: count, rate, remaining time.
class CountProgress {
 public:
  CountProgress(Console& console, std::string things, std::size_t total);
  void Done(std::size_t count);

 private:
  Console& console_;
  std::string things_;
  std::size_t total_;
  double start_ms_;
};

/// "2 h 05 min", "3 min 20 s", "45 s".
std::string DurationText(double seconds);

}  // namespace crossnav::app
