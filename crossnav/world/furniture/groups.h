// SPDX-License-Identifier: MIT
// Groups of furniture: a bed with its bedside tables, a desk with its chair, a row of kitchen
// units. Group frame: origin on the floor at the wall, x along the wall, y into the room, z up.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/world/furniture/furniture_source.h"

namespace crossnav::world {

struct GroupItem {
  ObjectModel model;
  Pose T_group_object = Pose::Identity();
  bool is_optional = false;  ///< left out if obstructed, e.g. by a window
};

struct Group {
  std::vector<GroupItem> items;
  Rect body;                 ///< footprint
  double clear_front_m = 0;  ///< must stay free in front of it
  double height_m = 0;       ///< of the tallest item

  void Add(ObjectModel model, const Vector3d& p_group, double yaw_rad = 0);
  /// Recomputes body and height, and moves everything so that the back lies on y = 0 and the
  /// middle on x = 0.
  void Settle();
};

/// A group or a single piece by kind: "bed group", "desk group", "sofa group", "tv group",
/// "dining group", "kitchen group", "washbasin group", or any furniture kind. `space_m` is the
/// length of the longest free wall (kitchens use it).
std::optional<Group> MakeGroup(std::string_view kind, const FurnitureSource& source, double space_m,
                               Rng& rng);

}  // namespace crossnav::world
