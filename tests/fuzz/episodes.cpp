// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/episodes.h"
#include "fuzz/harness.h"

FUZZ(episodes, input) {
  (void)crossnav::evaluation::ReadEpisodes(crossnav::fuzz::FileWith("episodes.json", input));
}
