// SPDX-License-Identifier: MIT
#include "crossnav/bench/config_file.h"
#include "fuzz/harness.h"

FUZZ(config, input) {
  crossnav::bench::RunConfig config;
  (void)crossnav::bench::ApplyConfigText(crossnav::fuzz::Text(input), "input.toml", config);
}
