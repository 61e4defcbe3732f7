// SPDX-License-Identifier: MIT
// `<hash>.house.json` beside a generated scene: its parameters (seed, sizes, switches, the
// furniture pack's hash), its rooms, and the credits of every imported model, which their licences
// require. Other readers of the folder ignore it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/layout/house_params.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

/// JSON text; `pack` is nullptr with parametric shapes only.
std::string HouseText(const HousePlan& plan, const HouseParams& params, const FurniturePack* pack);

struct HouseRoom {
  std::string name;         ///< "living room"
  double floor_m = 0;       ///< height of its ground
  std::vector<Rect> rects;  ///< world, up to the middle of its walls
};

/// Rooms of the scene in `folder`; empty without such a file (other scenes have none).
Result<std::vector<HouseRoom>> ReadHouseRooms(const std::filesystem::path& folder);

}  // namespace crossnav::world
