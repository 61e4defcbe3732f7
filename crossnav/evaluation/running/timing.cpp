// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/timing.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace crossnav::evaluation {

double ResidentMb() {
  std::ifstream file("/proc/self/statm");
  long all = 0, resident = 0;
  file >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

double PercentileOf(std::vector<double> sample, double share) {
  if (sample.empty()) return 0;
  const std::ptrdiff_t rank = std::lround(share * static_cast<double>(sample.size() - 1));
  std::nth_element(sample.begin(), sample.begin() + rank, sample.end());
  return sample[static_cast<std::size_t>(rank)];
}

std::map<std::string, StageTiming> TimingLog::Percentiles() const {
  std::map<std::string, StageTiming> percentiles;
  for (const auto& [stage, sample] : samples_ms) {
    percentiles[stage] = {PercentileOf(sample, 0.5), PercentileOf(sample, 0.95)};
  }
  return percentiles;
}

}  // namespace crossnav::evaluation
