// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/mezzanine.h"

#include <algorithm>

#include "crossnav/world/layout/room_types.h"
#include "crossnav/world/layout/stair_draw.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {
namespace {

constexpr double kLeastVoid_m = 1.4;  // chosen: a narrower void is a slot
constexpr double kFoot_m = 1.0;       // chosen: ground before the first riser

/// A stair along the wall at x0 towards the platform's edge at `y_edge`; nullopt if it is longer
/// than `room_m`.
std::optional<Stair> StairTo(const HousePlan& plan, const VoidPlace& place, double y_edge,
                             double room_m, Rng& rng) {
  const Room& above = plan.rooms[static_cast<std::size_t>(place.void_room)];
  const auto level = static_cast<std::size_t>(above.level);
  const double rise_m = plan.levels[level].floor_m - plan.levels[level - 1].floor_m;
  StairParams params;
  params.kind = StairKind::kAttic;
  const StairRange range = DrawStairRange(StairKind::kAttic, rng);
  const auto risers =
      RisersFor({rise_m, rise_m, place.slab_m}, range.riser_m.Draw(rng), {0.1, 0.29});
  if (!risers) return std::nullopt;
  params.rise_m = rise_m;
  params.risers = *risers;
  params.tread_m = range.tread_m.Draw(rng);
  params.width_m = range.width_m.Draw(rng);
  params.slab_m = place.slab_m;
  DrawStairBody(params, rng);
  const double run_m = (params.risers - 1) * params.tread_m;
  if (run_m + kFoot_m > room_m) return std::nullopt;
  params.has_left_rail = place.is_north;  // as seen when climbing; the wall is on the other side
  params.has_right_rail = !place.is_north;
  const double s = place.is_north ? 1 : -1;
  const Vector3d foot(above.rects[0].x0 + 0.08 + 0.5 * params.width_m, y_edge + s * run_m,
                      plan.levels[level - 1].floor_m);
  Stair stair = Moved(MakeStraightStair(params), foot, place.is_north ? 3 : 1);
  stair.voids.clear();  // the void is there already
  stair.lower_level = above.level - 1;
  stair.upper_level = above.level;
  stair.room = place.below_room;
  return stair;
}

}  // namespace

Mezzanine AddMezzanine(HousePlan& plan, const VoidPlace& place, Rng& rng) {
  const Rect whole = plan.rooms[static_cast<std::size_t>(place.void_room)].rects[0];
  const double depth_m = rng.Uniform(1.5, 2.4);
  if (whole.Depth() - depth_m < kLeastVoid_m) return {};
  Rect platform = whole, open = whole;
  double& edge = place.is_north ? platform.y1 : platform.y0;
  edge = place.is_north ? whole.y0 + depth_m : whole.y1 - depth_m;
  (place.is_north ? open.y0 : open.y1) = edge;
  Mezzanine made;
  const bool wants_stair = rng.Chance(0.6);
  auto stair = StairTo(plan, place, edge, open.Depth(), rng);
  made.has_own_stair = wants_stair && stair && place.below_room >= 0;
  if (made.has_own_stair) plan.stairs.push_back(std::move(*stair));
  Room& above = plan.rooms[static_cast<std::size_t>(place.void_room)];
  above.rects[0] = open;
  Room room;
  room.type = RoomType::kMezzanine;
  room.name = NameOf(room.type);
  room.level = above.level;
  room.rects = {platform};
  DrawFinishes(room, rng);
  plan.rooms.push_back(std::move(room));
  made.room = static_cast<int>(plan.rooms.size()) - 1;
  return made;
}

}  // namespace crossnav::world
