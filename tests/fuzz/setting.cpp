// SPDX-License-Identifier: MIT
#include "crossnav/bench/config_file.h"
#include "fuzz/harness.h"

// The values of --set, one a line.
FUZZ(setting, input) {
  crossnav::bench::RunConfig config;
  std::vector<std::string> overrides(1);
  for (const char c : crossnav::fuzz::Text(input)) {
    if (c == '\n') {
      overrides.emplace_back();
    } else {
      overrides.back() += c;
    }
  }
  (void)crossnav::bench::ApplyOverrides(overrides, config);
  for (const std::string& text : overrides) (void)crossnav::bench::ApplyOverrides({text}, config);
}
