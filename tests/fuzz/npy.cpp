// SPDX-License-Identifier: MIT
#include "crossnav/core/npy_file.h"
#include "fuzz/harness.h"

FUZZ(npy, input) {
  const auto file = crossnav::fuzz::FileWith("rows.npy", input);
  (void)crossnav::ReadNpy(file);
  (void)crossnav::ReadNpyRows(file, 2);
}
