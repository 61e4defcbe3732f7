// SPDX-License-Identifier: MIT
#include "crossnav/world/house/house_file.h"
#include "fuzz/harness.h"

FUZZ(house, input) {
  const auto file = crossnav::fuzz::FileWith("00001-House/House.house.json", input);
  (void)crossnav::world::ReadHouseRooms(file.parent_path());
}
