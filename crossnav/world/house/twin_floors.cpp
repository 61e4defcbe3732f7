// SPDX-License-Identifier: MIT
#include "crossnav/world/house/twin_floors.h"

#include <algorithm>

#include "crossnav/world/furniture/furnish.h"

namespace crossnav::world {
namespace {

constexpr double kBesideHole_m = 0.1;  // chosen: furniture keeps so far from the stair's hole

bool IsOpenToOthers(const Room& room) {
  return room.type == RoomType::kVoid || room.type == RoomType::kMezzanine ||
         room.type == RoomType::kBalcony || !room.has_ceiling || room.offset_m != 0;
}

Result<void> CheckTwinnable(const HousePlan& plan) {
  const bool is_open = std::any_of(plan.rooms.begin(), plan.rooms.end(), IsOpenToOthers);
  if (plan.levels.size() == 2 && plan.stairs.size() == 1 && plan.voids.empty() && !is_open)
    return {};
  return Fail(
      ErrorCode::kInvalid,
      "twins are made of two levels with one stair and no rooms open to others; try another "
      "seed",
      plan.id);
}

/// Rooms and walls of the lower level, and the same again above. A wall's outer doors are closed:
/// upstairs they would lead nowhere.
void DoubleShell(const HousePlan& plan, HousePlan& twin) {
  std::vector<int> lower(plan.rooms.size(), -1);
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    if (plan.rooms[i].level != 0) continue;
    lower[i] = static_cast<int>(twin.rooms.size());
    twin.rooms.push_back(plan.rooms[i]);
  }
  const int count = static_cast<int>(twin.rooms.size());
  for (int i = 0; i < count; ++i) {
    twin.rooms.push_back(twin.rooms[static_cast<std::size_t>(i)]);
    twin.rooms.back().level = 1;
  }
  for (const Wall& wall : plan.walls) {
    if (wall.level != 0) continue;
    Wall copy = wall;
    const auto mapped = [&](int room) {
      return room < 0 ? -1 : lower[static_cast<std::size_t>(room)];
    };
    copy.room = mapped(wall.room), copy.other_room = mapped(wall.other_room);
    for (Opening& opening : copy.openings)
      if (copy.other_room < 0 && opening.kind != OpeningKind::kWindow)
        opening.kind = OpeningKind::kDoorClosed;
    twin.walls.push_back(copy);
    copy.level = 1;
    copy.room = copy.room < 0 ? -1 : copy.room + count;
    copy.other_room = copy.other_room < 0 ? -1 : copy.other_room + count;
    twin.walls.push_back(copy);
  }
  for (Stair& stair : twin.stairs)
    stair.room = stair.room < 0 ? -1 : std::max(lower[static_cast<std::size_t>(stair.room)], 0);
}

bool IsOverHole(const HousePlan& twin, const Placement& piece) {
  const Box3 box = BoxAt(piece.model, piece.T_world_object);
  const auto voids = twin.VoidsOf(1);
  return std::any_of(voids.begin(), voids.end(), [&](const Rect& hole) {
    const Rect near = hole.Grown(kBesideHole_m);
    return box.max.x() > near.x0 && box.min.x() < near.x1 && box.max.y() > near.y0 &&
           box.min.y() < near.y1;
  });
}

void FurnishBoth(const HousePlan& plan, TwinFurniture furniture, const FurnitureSource& source,
                 Rng& rng, HousePlan& twin) {
  const int count = static_cast<int>(twin.rooms.size()) / 2;
  std::vector<int> lower(plan.rooms.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < plan.rooms.size(); ++i)
    if (plan.rooms[i].level == 0) lower[i] = next++;
  for (const Placement& piece : plan.furniture) {
    if (piece.room < 0 || lower[static_cast<std::size_t>(piece.room)] < 0) continue;
    Placement copy = piece;
    copy.room = lower[static_cast<std::size_t>(piece.room)];
    twin.furniture.push_back(copy);
    copy.room += count;
    copy.T_world_object.translation().z() += twin.levels[1].floor_m - twin.levels[0].floor_m;
    const bool is_copied = furniture == TwinFurniture::kSame && !IsOverHole(twin, copy);
    if (is_copied) twin.furniture.push_back(std::move(copy));
  }
  if (furniture == TwinFurniture::kSame) return;
  for (int room = count; room < 2 * count; ++room)
    FurnishRoom(twin, room, source, rng, [](std::string_view) { return true; });
}

}  // namespace

Result<HousePlan> TwinFloors(const HousePlan& plan, TwinFurniture furniture,
                             const FurnitureSource& source, Rng& rng) {
  if (auto ok = CheckTwinnable(plan); !ok) return tl::unexpected(ok.error());
  HousePlan twin;
  twin.id = plan.id;
  twin.levels = plan.levels;
  twin.levels[1].ceiling_m =
      plan.levels[1].floor_m + plan.levels[0].ceiling_m - plan.levels[0].floor_m;
  twin.stairs = plan.stairs;
  twin.railings = plan.railings;
  DoubleShell(plan, twin);
  FurnishBoth(plan, furniture, source, rng, twin);
  return twin;
}

}  // namespace crossnav::world
