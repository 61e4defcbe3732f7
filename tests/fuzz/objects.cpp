// SPDX-License-Identifier: MIT
#include "crossnav/homes/objects_file.h"
#include "fuzz/harness.h"

FUZZ(objects, input) {
  (void)crossnav::homes::ParseObjectsFile(crossnav::fuzz::Text(input), "objects.json");
}
