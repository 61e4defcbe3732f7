// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture.h"

#include <algorithm>
#include <iterator>

namespace crossnav::world {
namespace {

struct Kind {
  std::string_view name;
  ObjectModel (*make)(Rng&);
};

// Sorted by name.
constexpr Kind kKinds[] = {
    {"armchair", MakeArmchair},
    {"basket", MakeBasket},
    {"bathtub", MakeBathtub},
    {"bed", MakeBed},
    {"bedside table", MakeBedsideTable},
    {"bench", MakeBench},
    {"book", MakeBooks},
    {"bookcase", MakeBookcase},
    {"bowl", MakeBowl},
    {"box", MakeCardboardBox},
    {"ceiling lamp", MakeCeilingLamp},
    {"chair", MakeChair},
    {"chest of drawers", MakeChest},
    {"coffee table", MakeCoffeeTable},
    {"computer monitor", MakeMonitor},
    {"couch", MakeSofa},
    {"curtain", MakeCurtain},
    {"desk", MakeDesk},
    {"dining chair", MakeDiningChair},
    {"dining table", MakeDiningTable},
    {"floor lamp", MakeFloorLamp},
    {"kitchen cabinet", MakeKitchenUnit},
    {"kitchen upper cabinet", MakeUpperCabinet},
    {"laptop", MakeLaptop},
    {"mirror", MakeMirror},
    {"office chair", MakeOfficeChair},
    {"ottoman", MakeOttoman},
    {"picture", MakePicture},
    {"potted plant", MakePlant},
    {"refrigerator", MakeRefrigerator},
    {"rug", MakeRug},
    {"shower", MakeShower},
    {"sink", MakeSink},
    {"stool", MakeStool},
    {"stove", MakeCooker},
    {"table lamp", MakeTableLamp},
    {"toilet", MakeToilet},
    {"trash can", MakeBin},
    {"tv", MakeTv},
    {"tv stand", MakeTvStand},
    {"vase", MakeVase},
    {"wardrobe", MakeWardrobe},
    {"washbasin", MakeWashbasin},
};

}  // namespace

std::vector<std::string_view> FurnitureKinds() {
  std::vector<std::string_view> names;
  for (const Kind& k : kKinds) names.push_back(k.name);
  return names;
}

std::optional<ObjectModel> MakeFurniture(std::string_view kind, Rng& rng) {
  const auto it = std::lower_bound(std::begin(kKinds), std::end(kKinds), kind,
                                   [](const Kind& k, std::string_view n) { return k.name < n; });
  if (it == std::end(kKinds) || it->name != kind) return std::nullopt;
  return it->make(rng);
}

}  // namespace crossnav::world
