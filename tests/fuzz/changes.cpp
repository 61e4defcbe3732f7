// SPDX-License-Identifier: MIT
#include "crossnav/world/change/changes.h"
#include "fuzz/harness.h"

FUZZ(changes, input) {
  const auto day = crossnav::world::ParseChanges(crossnav::fuzz::Text(input), "changes.json");
  if (day) (void)crossnav::world::ChangesText(*day);
}
