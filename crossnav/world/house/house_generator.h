// SPDX-License-Identifier: MIT
// Furnished houses without end: draw a plan, furnish it, build it, and let it through only when it
// is usable (house_gate.h). Same parameters, same bytes.
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
  int attempts = 0;                      ///< plans drawn until one passed
  int floors = 0;                        ///< levels of the plan
  double area_m2 = 0;                    ///< walkable
  std::map<std::string, int> stairs;     ///< per kind
  std::map<std::string, int> rooms;      ///< per type
  std::map<std::string, int> instances;  ///< per category
  int pieces = 0;                        ///< of furniture
  std::uintmax_t bytes = 0;              ///< of all files
  std::map<std::string, int> refusals;   ///< reasons of the attempts that did not pass
};

/// Writes `<out_dir>/<id>/...` and returns what it is; kInvalid after AttemptsFor(params) attempts.
/// Furnished from `pack` where there is one, otherwise with the parametric shapes.
Result<HouseReport> GenerateHouse(const HouseParams& params, const std::filesystem::path& out_dir,
                                  const FurniturePack* pack = nullptr);

/// The furnished plan of one attempt, for tests and pictures.
Result<HousePlan> DrawFurnishedPlan(const HouseParams& params, int attempt,
                                    const FurnitureSource& source = {});

/// How many plans are tried.
int AttemptsFor(const HouseParams& params);

/// "00017-House17".
std::string SceneIdOf(const HouseParams& params);

}  // namespace crossnav::world
