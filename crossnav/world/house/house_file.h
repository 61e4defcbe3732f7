// SPDX-License-Identifier: MIT
// `<hash>.house.json` beside a generated scene: what it was drawn from (seed, sizes, switches, the
// furniture pack's hash), its rooms, and the credits of every imported model in it, which their
// licences ask to travel with it. Other readers of the folder ignore it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/layout/house_params.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// JSON text; `pack` is nullptr where only parametric shapes were used.
std::string HouseText(const HousePlan& plan, const HouseParams& params, const FurniturePack* pack);

struct HouseRoom {
  std::string name;         ///< "living room"
  double floor_m = 0;       ///< height of its ground
  std::vector<Rect> rects;  ///< world, up to the middle of its walls
};

/// Rooms of the scene in `folder`; empty where it has no such file (other scenes have none).
Result<std::vector<HouseRoom>> ReadHouseRooms(const std::filesystem::path& folder);

}  // namespace crossnav::world
