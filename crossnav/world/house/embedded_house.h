// SPDX-License-Identifier: MIT
// The house that ships with the program: two floors of 10 x 9 m joined by a straight flight, drawn
// by hand, so that the demo and the tests know every position. Sofa, tv and chairs are below only,
// beds and toilet above only, plants on both floors. World frame, metres.
#pragma once

#include <filesystem>

#include "crossnav/core/result.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

inline constexpr const char* kEmbeddedSceneId = "00001-CrossnavHouse";

/// Rooms, stair and furniture, for tests.
HousePlan EmbeddedHousePlan();

/// Writes it below `dir` in HM3D's layout and returns the scene's folder.
Result<std::filesystem::path> WriteEmbeddedHouse(const std::filesystem::path& dir);

}  // namespace crossnav::world
