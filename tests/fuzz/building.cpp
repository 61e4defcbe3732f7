// SPDX-License-Identifier: MIT
#include "crossnav/homes/building_home.h"
#include "fuzz/harness.h"

FUZZ(building, input) {
  using namespace crossnav;
  const auto building = homes::ParseBuilding(fuzz::Text(input), "building.json");
  if (!building) return;
  homes::BuildingHome home = homes::MakeHome(*building);
  const auto none = homes::Contents::Empty();
  homes::ModelStore models(none);
  std::vector<std::string> notes;
  homes::MendFloors(home.plan, homes::BuildHome(home.plan, models, home.models, notes));
  homes::MendThresholds(home, homes::BuildHome(home.plan, models, home.models, notes));
}
