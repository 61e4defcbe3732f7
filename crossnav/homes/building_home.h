// SPDX-License-Identifier: MIT
// An architect's building -> a home: its spaces are the rooms, its elements are pieces with
// unchanged models. Doors between spaces get the named parts that OpenDoor turns.
#pragma once

#include "crossnav/homes/building_file.h"
#include "crossnav/homes/home_builder.h"

namespace crossnav::homes {

struct BuildingHome {
  HomePlan plan;
  Substitutes models;  ///< of every piece
};

BuildingHome MakeHome(const Building& building);

/// Names the parts of a door's model (in its piece's frame) in OpenDoor's convention, and adds
/// sashes to the piece. `opens` is IfcDoorTypeOperationEnum.
void NameLeaves(world::NamedObj& door, HomePiece& piece, const std::string& opens);

/// Adds missing floors: to all rooms of a storey without slabs, and to single rooms. `scene` is the
/// home built so far; `plan.notes` reports it.
void MendFloors(HomePlan& plan, const sim::Scene& scene);

/// Adds thresholds if the floor has a gap in an inner door.
void MendThresholds(BuildingHome& home, const sim::Scene& scene);

}  // namespace crossnav::homes
