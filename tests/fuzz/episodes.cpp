// SPDX-License-Identifier: MIT
#include "crossnav/bench/episodes.h"
#include "fuzz/harness.h"

FUZZ(episodes, input) {
  (void)crossnav::bench::ReadEpisodes(crossnav::fuzz::FileWith("episodes.json", input));
}
