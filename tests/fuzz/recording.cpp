// SPDX-License-Identifier: MIT
#include "crossnav/recordings/recording.h"
#include "fuzz/harness.h"

FUZZ(recording, input) {
  crossnav::recordings::RecordingOptions options;
  options.skip_damaged = !input.empty() && input.back() % 2 == 1;
  (void)crossnav::recordings::ReadRecording(
      crossnav::fuzz::FileWith("bag.mcap", input), options,
      [](const auto&, const auto&) -> crossnav::Result<void> { return {}; });
}
