// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visits.h"
#include "fuzz/harness.h"

FUZZ(visits, input) {
  const std::string text = crossnav::fuzz::Text(input);
  const auto file = crossnav::evaluation::ParseVisits(text, "visits.json");
  if (file) (void)crossnav::evaluation::VisitsText(file->visits);
  const auto results = crossnav::evaluation::ParseVisitResults(text, "visits.jsonl");
  if (results) (void)crossnav::evaluation::VisitResultsText(*results);
}
