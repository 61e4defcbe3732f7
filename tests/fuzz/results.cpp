// SPDX-License-Identifier: MIT
#include "crossnav/bench/metrics.h"
#include "crossnav/bench/result_records.h"
#include "fuzz/harness.h"

FUZZ(results, input) {
  const auto file = crossnav::fuzz::FileWith("results.jsonl", input);
  (void)crossnav::bench::ReadResults(file);
  (void)crossnav::bench::MergeResults({&file, 1}, true);
}
