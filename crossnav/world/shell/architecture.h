// SPDX-License-Identifier: MIT
// The shell of a house: floors, ceilings, walls with doors and windows, stairs, railings, as
// instances with HM3D-like names.
#pragma once

#include <set>

#include "crossnav/world/plan/plan.h"
#include "crossnav/world/shell/scene_builder.h"

namespace crossnav::world {

void BuildFloorsAndCeilings(const HousePlan& plan, SceneBuilder& scene);
void BuildWalls(const HousePlan& plan, SceneBuilder& scene);
void BuildStairs(const HousePlan& plan, SceneBuilder& scene);
void BuildBlocks(const HousePlan& plan, SceneBuilder& scene);
void BuildRailing(const Railing& railing, SceneBuilder& scene);

struct BuildOptions {
  bool has_textures = false;
  std::uint64_t texture_seed = 1;
};

/// A scene and its materials that emit light.
struct BuiltHouse {
  sim::Scene scene;
  std::set<int> glowing;
};

/// The whole house, furniture included.
BuiltHouse BuildHouseWithLights(const HousePlan& plan, const BuildOptions& options);
sim::Scene BuildHouse(const HousePlan& plan, const BuildOptions& options = {});

}  // namespace crossnav::world
