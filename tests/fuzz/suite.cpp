// SPDX-License-Identifier: MIT
#include "crossnav/bench/suite.h"
#include "fuzz/harness.h"

FUZZ(suite, input) {
  (void)crossnav::bench::ReadManifest(crossnav::fuzz::FileWith("suite.json", input));
}
