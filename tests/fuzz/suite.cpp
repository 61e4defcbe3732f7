// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/suite.h"
#include "fuzz/harness.h"

FUZZ(suite, input) {
  (void)crossnav::evaluation::ReadManifest(crossnav::fuzz::FileWith("suite.json", input));
}
