// SPDX-License-Identifier: MIT
#include "crossnav/trace/replay_reader.h"
#include "fuzz/harness.h"

FUZZ(replay, input) {
  (void)crossnav::trace::ReadReplay(crossnav::fuzz::FileWith("replay.mcap", input));
}
