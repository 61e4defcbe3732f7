// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/scene_reader.h"
#include "fuzz/harness.h"

FUZZ(semantic_text, input) {
  const std::string text = crossnav::fuzz::Text(input);
  (void)crossnav::sim::ParseSemanticText(text, "input.semantic.txt");
  (void)crossnav::sim::ParseCategoryTable(text, "categories.tsv");
}
