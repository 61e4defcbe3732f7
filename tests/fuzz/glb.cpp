// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/gltf_reader.h"
#include "fuzz/harness.h"

// A folder that cannot exist: files named by the model are missing.
FUZZ(glb, input) {
  (void)crossnav::sim::ParseGlb(input, "input.glb", "/dev/null");
}
