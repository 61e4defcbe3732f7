// SPDX-License-Identifier: MIT
// Places for an object of a house: free ground, or a free part of a top. Turns are plausible; large
// objects keep their back to a wall. World frame, metres.
#pragma once

#include <memory>
#include <optional>
#include <set>

#include "crossnav/core/rng.h"
#include "crossnav/world/change/changes.h"
#include "crossnav/world/change/house_view.h"
#include "crossnav/world/change/scene_edit.h"

namespace crossnav::world {

struct Standing {
  Shift shift;  ///< from its old place
  ChangePlace place;
};

/// A house on the evening before, and its scene on the way to the next day.
struct Night {
  const HouseView& view;  ///< of the evening
  sim::Scene& scene;
  std::unique_ptr<sim::RayCaster> caster;  ///< of the current scene: renewed after each edit
  std::set<int> changed = {};              ///< instances; no object is put on or beside them
};

/// Place of `object` for a list of changes.
ChangePlace PlaceOf(const HouseView& view, const sim::SceneInstance& object);

/// Whether people move the object: by its name, with a support and without a load.
bool MayMove(const HouseView& view, const sim::SceneInstance& object);

/// Draws a place for `object` by `kind` (a move, or kAdded: anywhere else). Empty after a few dozen
/// failed draws.
std::optional<Standing> FindPlace(const Night& night, const sim::SceneInstance& object,
                                  ChangeKind kind, Rng& rng);

}  // namespace crossnav::world
