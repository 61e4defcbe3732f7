// SPDX-License-Identifier: MIT
#include "crossnav/store/map_file.h"
#include "fuzz/harness.h"

FUZZ(map, input) {
  const auto file = crossnav::fuzz::FileWith("home.map", input);
  crossnav::store::LoadOptions options;
  options.skip_damaged = true;
  (void)crossnav::store::LoadMemory(file, options);
}
