// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture_pack.h"
#include "fuzz/harness.h"

FUZZ(pack, input) {
  crossnav::fuzz::FileWith("pack/furniture.pack", {});
  const auto manifest = crossnav::fuzz::FileWith("pack/manifest.json", input);
  (void)crossnav::world::FurniturePack::Load(manifest.parent_path());
}
