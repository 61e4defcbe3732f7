// SPDX-License-Identifier: MIT
// A generated house as language knows homes, from the plan and the scene: the truth that answers
// about its map are held against. World frame.
#pragma once

#include <set>
#include <vector>

#include "crossnav/language/known_home.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::evaluation {

inline constexpr double kStorey_m = 1.5;  ///< as sim::Floor

struct TrueHome {
  language::KnownHome home;
  std::vector<int> instances;  ///< id of each thing
};

/// The instances of `seen`, without the shell. Rooms with no wall between them are one room of
/// several types.
TrueHome TrueHomeOf(const world::HousePlan& plan, const sim::Scene& scene,
                    const std::set<int>& seen);

/// Whether there is a word for the instance, so that it can be spoken of.
bool HasWord(const sim::SceneInstance& instance);

/// Canonical name of an instance.
std::string NameOf(const sim::SceneInstance& instance);

}  // namespace crossnav::evaluation
