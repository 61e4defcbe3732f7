// SPDX-License-Identifier: MIT
// A building as architects write it -> a home: its spaces are the rooms, its elements are pieces
// whose models stand as they are. Doors between spaces get the parts that OpenDoor turns.
#pragma once

#include "crossnav/homes/building_file.h"
#include "crossnav/homes/home_builder.h"

namespace crossnav::homes {

struct BuildingHome {
  HomePlan plan;
  Substitutes models;  ///< of every piece
};

BuildingHome MakeHome(const Building& building);

/// Names the parts of a door's model (in its piece's frame) as OpenDoor reads them, and gives the
/// piece its sashes. `opens` is IfcDoorTypeOperationEnum.
void NameLeaves(world::NamedObj& door, HomePiece& piece, const std::string& opens);

/// Draws the floor of rooms that lack one: of all rooms of a storey without slabs, and of single
/// ones. `scene` is the home as built so far; `plan.notes` says so.
void MendFloors(HomePlan& plan, const sim::Scene& scene);

/// Adds thresholds where the floor has a gap in an inner door.
void MendThresholds(BuildingHome& home, const sim::Scene& scene);

}  // namespace crossnav::homes
