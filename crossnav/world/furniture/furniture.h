// SPDX-License-Identifier: MIT
// Parametric furniture out of solids, in many looks: the seed decides sizes, colours and style. All
// models stand on the floor at their origin with the front towards +y (object_model.h).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

/// Kinds of MakeFurniture, sorted.
std::vector<std::string_view> FurnitureKinds();

/// A model of `kind` ("sofa", "dining chair", ...), or nullopt for an unknown kind.
std::optional<ObjectModel> MakeFurniture(std::string_view kind, Rng& rng);

// furniture_seating.cpp
ObjectModel MakeChair(Rng& rng);
ObjectModel MakeDiningChair(Rng& rng);
ObjectModel MakeOfficeChair(Rng& rng);
ObjectModel MakeArmchair(Rng& rng);
ObjectModel MakeSofa(Rng& rng);
ObjectModel MakeStool(Rng& rng);
ObjectModel MakeBench(Rng& rng);

// furniture_bedroom.cpp
ObjectModel MakeBed(Rng& rng);
ObjectModel MakeBedsideTable(Rng& rng);
ObjectModel MakeWardrobe(Rng& rng);
ObjectModel MakeChest(Rng& rng);

// furniture_bathroom.cpp
ObjectModel MakeToilet(Rng& rng);
ObjectModel MakeWashbasin(Rng& rng);
ObjectModel MakeBathtub(Rng& rng);
ObjectModel MakeShower(Rng& rng);
ObjectModel MakeMirror(Rng& rng);

// furniture_living.cpp
ObjectModel MakeTv(Rng& rng);
ObjectModel MakeTvStand(Rng& rng);
ObjectModel MakePlant(Rng& rng);
ObjectModel MakeCoffeeTable(Rng& rng);
ObjectModel MakeBookcase(Rng& rng);
ObjectModel MakePicture(Rng& rng);
ObjectModel MakeFloorLamp(Rng& rng);
ObjectModel MakeRug(Rng& rng);

// furniture_work.cpp
ObjectModel MakeDiningTable(Rng& rng);
ObjectModel MakeDesk(Rng& rng);
ObjectModel MakeMonitor(Rng& rng);
ObjectModel MakeLaptop(Rng& rng);
ObjectModel MakeKitchenUnit(Rng& rng);
ObjectModel MakeUpperCabinet(Rng& rng);
ObjectModel MakeRefrigerator(Rng& rng);
ObjectModel MakeCooker(Rng& rng);
ObjectModel MakeSink(Rng& rng);

// furniture_small.cpp
ObjectModel MakeVase(Rng& rng);
ObjectModel MakeBowl(Rng& rng);
ObjectModel MakeBooks(Rng& rng);
ObjectModel MakeTableLamp(Rng& rng);
ObjectModel MakeCardboardBox(Rng& rng);
ObjectModel MakeBin(Rng& rng);
ObjectModel MakeBasket(Rng& rng);
ObjectModel MakeOttoman(Rng& rng);
ObjectModel MakeCeilingLamp(Rng& rng);  ///< origin at the ceiling
ObjectModel MakeCurtain(Rng& rng);

}  // namespace crossnav::world
