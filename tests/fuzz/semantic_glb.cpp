// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/scene_reader.h"
#include "fuzz/harness.h"

FUZZ(semantic_glb, input) {
  const auto model =
      crossnav::sim::ParseGlb(input, "input.glb", "/dev/null", {.raw_vertex_colours = true});
  if (!model) return;
  const crossnav::sim::SemanticLine lines[] = {{1, 0xFF0000, "chair", 0}, {2, 0x00FF00, "bed", 1}};
  (void)crossnav::sim::InstancesByColour(*model, lines);
}
