// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "fuzz/harness.h"

FUZZ(results, input) {
  const auto file = crossnav::fuzz::FileWith("results.jsonl", input);
  (void)crossnav::evaluation::ReadResults(file);
  (void)crossnav::evaluation::MergeResults({&file, 1}, true);
}
