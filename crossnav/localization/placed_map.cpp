// SPDX-License-Identifier: MIT
#include "crossnav/localization/placed_map.h"

#include "crossnav/localization/pose_search.h"

namespace crossnav::localization {
namespace {

constexpr double kPadUp_m = 4;  // chosen: a scan's points above and below the map's box

}  // namespace

Result<PlacedMap> PlaceMap(const geometry::VoxelMap& map, const LocalizeConfig& config) {
  auto dense = MakeDenseMap(map, config.reach_m + 1, kPadUp_m);
  if (!dense) return tl::unexpected(dense.error());
  PlacedMap placed{std::move(*dense), planner::GroundMap(map.config()), {}};
  placed.ground.Rebuild(map);
  placed.places = StandingPlaces(map, placed.ground, config.place_step_m);
  if (placed.places.empty())
    return Fail(ErrorCode::kInvalid, "the map has no ground to stand on", "map");
  return placed;
}

}  // namespace crossnav::localization
