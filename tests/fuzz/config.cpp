// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/settings/config_file.h"
#include "fuzz/harness.h"

FUZZ(config, input) {
  crossnav::evaluation::RunConfig config;
  (void)crossnav::evaluation::ApplyConfigText(crossnav::fuzz::Text(input), "input.toml", config);
}
