// SPDX-License-Identifier: MIT
// `crossnav bench noise`: success and map error under each kind of noise.
#pragma once

#include "commands.h"

namespace crossnav::app {

struct NoiseSweepOptions {
  std::string scenes, episodes;
  int count = 6;  ///< of the episodes, evenly over all scenes
  int jobs = 1;
  std::vector<std::string> kinds;  ///< empty = all
  std::string out;                 ///< JSON for scripts/plot_noise.py; empty = none
};
/// Valid names in NoiseSweepOptions::kinds.
std::vector<std::string> NoiseKinds();
Result<void> BenchNoise(const NoiseSweepOptions& options, const CommonOptions& common,
                        Console& console);

}  // namespace crossnav::app
