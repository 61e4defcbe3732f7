// SPDX-License-Identifier: MIT
// A model fitted to its piece: the model's rotation, then its box scaled to width x depth x height,
// mirrored, tilted. The result's own frame: x to the right, y to the back, z up, metres, origin
// under the middle of the footprint.
#pragma once

#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "crossnav/homes/home_plan.h"
#include "crossnav/world/models/obj_reader.h"

namespace crossnav::homes {

inline constexpr double kOpen_rad = std::numbers::pi / 2;  ///< swing of an open leaf

/// `obj` with the piece's size and colours.
world::NamedObj Fitted(const world::NamedObj& obj, const HomePiece& piece);

/// A box of the piece's size, for pieces without a model.
world::NamedObj BoxFor(const HomePiece& piece);

/// Pose of a fitted model in the world.
Pose PoseOf(const HomePlan& plan, const HomePiece& piece);

/// Whether `model` (at `T_door_model` in the frame of the door's piece) leaves the passage through
/// the door free, up to `reach_m` before and behind the wall.
bool IsFree(const world::ObjectModel& model, const Pose& T_door_model, const HomePiece& door,
            double reach_m);

/// Opens a blocked door so that `is_free` holds: turns the model's named leaves to either side or
/// removes them, moves sliding leaves aside, else substitutes a plain frame. Returns a description
/// of the change; empty = the door was open already.
std::string OpenDoor(world::NamedObj& obj, const HomePiece& piece,
                     const std::function<bool(const world::ObjectModel&)>& is_free);

}  // namespace crossnav::homes
