// SPDX-License-Identifier: MIT
// CPU time per stage over many steps, and its percentiles; memory. Timings never influence a
// decision.
#pragma once

#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::evaluation {

/// CPU time of this process [ms].
inline double CpuMs() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Monotonic wall-clock time [ms].
inline double WallMs() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Resident memory of this process [MB].
double ResidentMb();

/// Time since the last lap.
class Stopwatch {
 public:
  struct Lap {
    double wall_ms = 0, cpu_ms = 0;
  };
  Lap Next() {
    const Lap now{WallMs(), CpuMs()};
    const Lap lap{now.wall_ms - last_.wall_ms, now.cpu_ms - last_.cpu_ms};
    last_ = now;
    return lap;
  }

 private:
  Lap last_{WallMs(), CpuMs()};
};

/// Value at `share` in [0, 1] of the sample, nearest rank; 0 for an empty sample.
double PercentileOf(std::vector<double> sample, double share);

/// Samples by stage name.
struct TimingLog {
  std::map<std::string, std::vector<double>> samples_ms;

  void Add(const std::string& stage, double ms) { samples_ms[stage].push_back(ms); }
  void Add(const std::vector<trace::StageTime>& times) {
    for (const trace::StageTime& time : times) Add(time.stage, time.ms);
  }
  std::map<std::string, StageTiming> Percentiles() const;
};

}  // namespace crossnav::evaluation
