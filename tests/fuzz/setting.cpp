// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/settings/config_file.h"
#include "fuzz/harness.h"

// The values of --set, one a line.
FUZZ(setting, input) {
  crossnav::evaluation::RunConfig config;
  std::vector<std::string> overrides(1);
  for (const char c : crossnav::fuzz::Text(input)) {
    if (c == '\n') {
      overrides.emplace_back();
    } else {
      overrides.back() += c;
    }
  }
  (void)crossnav::evaluation::ApplyOverrides(overrides, config);
  for (const std::string& text : overrides)
    (void)crossnav::evaluation::ApplyOverrides({text}, config);
}
