// SPDX-License-Identifier: MIT
// A picture of many houses: for each a view from inside and every floor from above, with its seed,
// floors, stairs and area.
#pragma once

#include <filesystem>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"
#include "crossnav/world/house/house_generator.h"

namespace crossnav::app {

class ContactSheet {
 public:
  /// Reads the house back from its folder and draws it. `seed` also selects the view.
  Result<void> Add(const world::HouseReport& house, std::uint64_t seed);
  Result<void> Write(const std::filesystem::path& file) const;

 private:
  std::vector<RgbImage> tiles_;
};

}  // namespace crossnav::app
