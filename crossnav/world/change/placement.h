// SPDX-License-Identifier: MIT
// Where an object of a house may be put: on free ground, or on a free part of a top, turned as
// people turn things, large ones with their back to a wall again. World frame, metres.
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
  Shift shift;  ///< from where it stood
  ChangePlace place;
};

/// A house on the evening before, and its scene on the way to the next day.
struct Night {
  const HouseView& view;  ///< of the evening
  sim::Scene& scene;
  std::unique_ptr<sim::RayCaster> caster;  ///< of the scene as it is now: renewed after each edit
  std::set<int> changed = {};              ///< instances; nothing is put on or beside them
};

/// Where `object` stands, in the words of a list of changes.
ChangePlace PlaceOf(const HouseView& view, const sim::SceneInstance& object);

/// Whether people move it: its name, and that it stands on something and carries nothing.
bool MayMove(const HouseView& view, const sim::SceneInstance& object);

/// A place for `object` that makes the change one of `kind` (a move, or kAdded: anywhere else).
/// Nothing where a few dozen draws give none.
std::optional<Standing> FindPlace(const Night& night, const sim::SceneInstance& object,
                                  ChangeKind kind, Rng& rng);

}  // namespace crossnav::world
