// SPDX-License-Identifier: MIT
// Generator of furnished houses: draws a plan, furnishes it, builds it, and accepts it if usable
// (house_gate.h). Same parameters, same bytes.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/world/furniture/furniture_source.h"
#include "crossnav/world/layout/house_params.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

struct HouseReport {
  std::string scene_id;
  std::filesystem::path folder;
  int attempts = 0;                      ///< plans drawn until the first that passed
  int floors = 0;                        ///< levels of the plan
  double area_m2 = 0;                    ///< walkable
  std::map<std::string, int> stairs;     ///< per kind
  std::map<std::string, int> rooms;      ///< per type
  std::map<std::string, int> instances;  ///< per category
  int pieces = 0;                        ///< of furniture
  std::uintmax_t bytes = 0;              ///< of all files
  std::map<std::string, int> refusals;   ///< reasons of rejected attempts
};

/// Writes `<out_dir>/<id>/...` and reports its content; kInvalid after AttemptsFor(params)
/// attempts. Furnished from `pack` if given, else with the parametric shapes.
Result<HouseReport> GenerateHouse(const HouseParams& params, const std::filesystem::path& out_dir,
                                  const FurniturePack* pack = nullptr);

/// The furnished plan of one attempt, for tests and pictures.
Result<HousePlan> DrawFurnishedPlan(const HouseParams& params, int attempt,
                                    const FurnitureSource& source = {});

/// Maximum number of plans tried.
int AttemptsFor(const HouseParams& params);

/// "00017-House17".
std::string SceneIdOf(const HouseParams& params);

}  // namespace crossnav::world
