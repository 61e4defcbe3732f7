// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture_pack.h"
#include "fuzz/harness.h"

// A model of a pack before it is packed.
FUZZ(pack_model, input) {
  (void)crossnav::world::DecodeModel(crossnav::fuzz::Text(input), {}, "furniture.pack");
}
