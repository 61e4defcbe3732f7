// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "crossnav/core/check.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/trials/trial_worlds.h"
#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/plan/plan_walls.h"

namespace crossnav::evaluation {

using world::HousePlan;
using world::Opening;
using world::OpeningKind;
using world::Rect;
using world::Room;
using world::RoomType;

namespace {

constexpr Rect kRoom{0, 0, 6, 5};        // chosen: a living room
constexpr Rect kNextRoom{6, 0, 9, 5};    // chosen: a second room to explore
constexpr double kStoreyHeight_m = 2.8;  // chosen: floor to floor
constexpr double kSlab_m = 0.3;

int AddRectangle(HousePlan& plan, RoomType type, int level, const Rect& rect) {
  Room room;
  room.type = type;
  room.name = "room";
  room.level = level;
  room.rects = {rect};
  room.has_ceiling = type != RoomType::kBalcony;
  plan.rooms.push_back(std::move(room));
  return static_cast<int>(plan.rooms.size()) - 1;
}

void AddLevels(HousePlan& plan, int count) {
  for (int level = 0; level < count; ++level) {
    plan.levels.push_back({level * kStoreyHeight_m, (level + 1) * kStoreyHeight_m - kSlab_m});
  }
}

void Open(HousePlan& plan, int room_a, int room_b, const Opening& opening) {
  world::Wall* wall = world::FindWall(plan, room_a, room_b);
  CROSSNAV_CHECK(wall != nullptr, "no wall to open");
  Opening placed = opening;
  if (placed.center_m == 0) placed.center_m = 0.5 * (wall->b - wall->a).norm();
  CROSSNAV_CHECK(world::AddOpening(*wall, placed), "an opening finds no place");
}

/// Two rooms with a doorway between them on one level.
FalseWorld TwoRooms() {
  FalseWorld made;
  AddLevels(made.plan, 1);
  const int room = AddRectangle(made.plan, RoomType::kLiving, 0, kRoom);
  const int next = AddRectangle(made.plan, RoomType::kLiving, 0, kNextRoom);
  world::DeriveWalls(made.plan, {});
  Open(made.plan, room, next, {});
  return made;
}

/// A hall above, open over a railing to a hall below; the start is in either, the other is
/// unreachable.
FalseWorld Gallery(Rng& rng) {
  FalseWorld made;
  HousePlan& plan = made.plan;
  AddLevels(plan, 2);
  const double edge_m = rng.Uniform(2.0, 3.0);
  const Rect near{kRoom.x0, kRoom.y0, kRoom.x1, edge_m}, far{kRoom.x0, edge_m, kRoom.x1, kRoom.y1};
  const int under = AddRectangle(plan, RoomType::kHall, 0, near);
  const int below = AddRectangle(plan, RoomType::kHall, 0, far);
  plan.rooms[static_cast<std::size_t>(below)].has_ceiling = false;
  AddRectangle(plan, RoomType::kHall, 1, near);
  AddRectangle(plan, RoomType::kVoid, 1, far);
  plan.voids.emplace_back(1, far);
  world::DeriveWalls(plan, {});
  Opening passage;
  passage.kind = OpeningKind::kPassage;
  passage.width_m = 2.4;
  Open(plan, under, below, passage);
  world::RailVoids(plan, rng.Int(0, 2));
  const bool is_above = rng.Chance(0.5);
  made.start_m = is_above ? kStoreyHeight_m : 0;
  made.p_seen_world = {3, is_above ? edge_m - 0.3 : edge_m + 0.1, kStoreyHeight_m};
  return made;
}

/// A platform outside an upper room over the ground below, railed, mostly with a side left open.
FalseWorld Balcony(Rng& rng) {
  FalseWorld made;
  HousePlan& plan = made.plan;
  AddLevels(plan, 2);
  AddRectangle(plan, RoomType::kLiving, 0, kRoom);
  AddRectangle(plan, RoomType::kBalcony, 0, {-3, -4, 9, 0});  // the ground outside
  const int room = AddRectangle(plan, RoomType::kLiving, 1, kRoom);
  const double x0 = rng.Uniform(0.5, 1.5), x1 = rng.Uniform(4.0, 5.5);
  const Rect out{x0, -rng.Uniform(1.1, 1.6), x1, 0};
  const int balcony = AddRectangle(plan, RoomType::kBalcony, 1, out);
  world::DeriveWalls(plan, {});
  Opening door;
  door.width_m = 0.9;
  Open(plan, room, balcony, door);
  const double z = kStoreyHeight_m;
  const int style = rng.Int(0, 2);
  plan.railings.push_back({{out.x0, out.y0, z}, {out.x1, out.y0, z}, 0.95, style});
  plan.railings.push_back({{out.x0, out.y0, z}, {out.x0, 0, z}, 0.95, style});
  if (!rng.Chance(0.7)) plan.railings.push_back({{out.x1, out.y0, z}, {out.x1, 0, z}, 0.95, style});
  made.start_m = z;
  made.p_seen_world = {0.5 * (x0 + x1), -0.3, z};
  return made;
}

/// Windows down to the knee or the floor, with the outdoors visible in them.
FalseWorld Windows(Rng& rng) {
  FalseWorld made = TwoRooms();
  Opening window;
  window.kind = OpeningKind::kWindow;
  window.width_m = rng.Uniform(1.0, 2.0);
  window.sill_m = rng.Uniform(0.1, 0.6);
  window.head_m = rng.Uniform(1.9, 2.2);
  window.center_m = rng.Uniform(1.5, 3.5);
  Open(made.plan, 0, -1, window);
  for (world::Wall& wall : made.plan.walls) {  // a second window, on another side
    if (wall.room == 0 && wall.other_room < 0 && wall.openings.empty()) {
      CROSSNAV_CHECK(world::AddOpening(wall, window), "a window finds no place");
      break;
    }
  }
  for (const world::Wall& wall : made.plan.walls) {
    if (wall.room != 0 || wall.openings.empty() || wall.openings[0].kind != OpeningKind::kWindow)
      continue;
    const auto middle = (wall.a + (wall.b - wall.a).normalized() * window.center_m).eval();
    const auto inward = (kRoom.Center() - middle).normalized().eval();
    made.p_seen_world << middle + 0.3 * inward, window.sill_m;
  }
  return made;
}

void Place(FalseWorld& made, world::ObjectModel model, const Vector3d& p_world, double yaw_rad) {
  made.plan.furniture.push_back({std::move(model), world::StandAt(p_world, yaw_rad), 0});
}

/// Low furniture of all sorts in the room, at any angle.
FalseWorld Furniture(Rng& rng) {
  FalseWorld made = TwoRooms();
  constexpr std::string_view kLow[] = {
      "couch", "bed",      "ottoman",       "coffee table", "bench", "chest of drawers",
      "stool", "armchair", "bedside table", "bathtub",      "box",   "tv stand"};
  for (int i = 0; i < 6; ++i) {
    auto model = world::MakeFurniture(kLow[rng.Below(std::size(kLow))], rng);
    CROSSNAV_CHECK(model.has_value(), "no such furniture");
    const int column = i % 3, row = i / 3;
    const double off_y = rng.Uniform(-0.1, 0.1), off_x = rng.Uniform(-0.1, 0.1);
    const Vector3d p(1.2 + 1.8 * column + off_x, 1.4 + 2.2 * row + off_y, 0);
    if (i == 0) made.p_seen_world = p + Vector3d(0, 0, model->Size().z() + 0.1);
    Place(made, std::move(*model), p, rng.Uniform(0, 2 * std::numbers::pi));
  }
  return made;
}

/// Boards rising like a stair against the wall: too high to step on, or too narrow to stand on.
FalseWorld Shelf(Rng& rng) {
  FalseWorld made = TwoRooms();
  world::ModelBuilder shelf("shelf");
  shelf.Colour({160, 120, 80});
  const bool is_narrow = rng.Chance(0.5);
  const double step_m = is_narrow ? rng.Uniform(0.20, 0.28) : rng.Uniform(0.34, 0.42);
  const double board_m = is_narrow ? rng.Uniform(0.06, 0.10) : rng.Uniform(0.25, 0.35);
  const double half_m = 0.5 * rng.Uniform(0.6, 1.2);
  const int steps = static_cast<int>(1.9 / step_m);
  for (int i = 0; i < steps; ++i) {  // its back, the highest step, to the wall at y = 0
    const double y = (steps - 1 - i) * board_m, top = (i + 1) * step_m;
    shelf.mesh.AddBox({-half_m, y, rng.Chance(0.5) ? 0 : top - 0.04}, {half_m, y + board_m, top});
  }
  const Vector3d p(rng.Uniform(1.5, 4.5), 0.08, 0);
  made.p_seen_world = p + Vector3d(0, steps * board_m + 0.1, 0.1);
  Place(made, shelf.Finish(), p, 0);
  return made;
}

/// A solid wedge that rises from the floor to a wall.
FalseWorld Slope(Rng& rng) {
  FalseWorld made = TwoRooms();
  world::ModelBuilder slope("slope");
  slope.Colour({150, 150, 150});
  const double angle_rad = DegToRad(rng.Uniform(12, 50)), top_m = rng.Uniform(0.5, 1.8);
  const double run_m = std::min(top_m / std::tan(angle_rad), 3.0);
  const double high_m = run_m * std::tan(angle_rad), half_m = 0.5 * rng.Uniform(1.0, 2.0);
  const Vector3d a(-half_m, run_m, 0), b(half_m, run_m, 0), c(half_m, 0, 0), d(-half_m, 0, 0);
  const Vector3d up(0, 0, high_m);
  slope.mesh.AddQuad(b, a, d + up, c + up);
  slope.mesh.AddQuad(d, c, c + up, d + up);
  slope.mesh.AddTriangle(b, c + up, c);
  slope.mesh.AddTriangle(a, d, d + up);
  const Vector3d p(rng.Uniform(1.5, 4.5), 0.08, 0);
  made.p_seen_world = p + Vector3d(0, run_m + 0.2, 0.1);
  Place(made, slope.Finish(), p, 0);
  return made;
}

/// Boxes from the front to the back wall, in increasing height.
world::ObjectModel Terrace(std::string name, const std::vector<world::Vector2d>& depth_and_top,
                           double half_m) {
  world::ModelBuilder made(std::move(name));
  made.Colour({130, 104, 84});
  double y = 0;
  for (const world::Vector2d& box : depth_and_top) y += box.x();
  for (const world::Vector2d& box : depth_and_top) {
    made.mesh.AddBox({-half_m, y - box.x(), 0}, {half_m, y, box.y()});
    y -= box.x();
  }
  return made.Finish();
}

FalseWorld PlaceAtWall(world::ObjectModel model, Rng& rng) {
  FalseWorld made = TwoRooms();
  const Vector3d p(rng.Uniform(1.5, 4.5), 0.08, 0);
  made.p_seen_world = p + Vector3d(0, model.Size().y() + 0.15, 0.1);
  Place(made, std::move(model), p, 0);
  return made;
}

/// A low seat with its back to a wall: a step that leads nowhere.
FalseWorld Seat(Rng& rng) {
  const double seat_m = rng.Uniform(0.22, 0.45), back_m = rng.Uniform(0.55, 0.95);
  const double half_m = 0.5 * rng.Uniform(0.7, 2.0), deep_m = rng.Uniform(0.4, 0.6);
  return PlaceAtWall(Terrace("couch", {{deep_m, seat_m}, {0.18, back_m}}, half_m), rng);
}

/// Two or three pieces in a row, each within a step of the piece before.
FalseWorld Stack(Rng& rng) {
  std::vector<world::Vector2d> boxes;
  double top_m = 0;
  for (int i = rng.Int(2, 3); i > 0; --i) {
    top_m += rng.Uniform(0.20, 0.36);
    boxes.emplace_back(rng.Uniform(0.25, 0.5), top_m);
  }
  return PlaceAtWall(Terrace("chest of drawers", boxes, 0.5 * rng.Uniform(0.5, 1.2)), rng);
}

}  // namespace

std::string_view NameOf(FalseEntrance kind) {
  switch (kind) {
    case FalseEntrance::kGallery:
      return "gallery";
    case FalseEntrance::kBalcony:
      return "balcony";
    case FalseEntrance::kWindow:
      return "window";
    case FalseEntrance::kFurniture:
      return "furniture";
    case FalseEntrance::kShelf:
      return "shelf like steps";
    case FalseEntrance::kSlope:
      return "slope to nowhere";
    case FalseEntrance::kSeat:
      return "seat beside a wall";
    case FalseEntrance::kStack:
      return "stack of low furniture";
  }
  return "?";
}

FalseWorld MakeFalseWorld(FalseEntrance kind, std::uint64_t seed) {
  Rng rng(seed, 100 + static_cast<std::uint64_t>(kind));
  FalseWorld made;
  switch (kind) {
    case FalseEntrance::kGallery:
      made = Gallery(rng);
      break;
    case FalseEntrance::kBalcony:
      made = Balcony(rng);
      break;
    case FalseEntrance::kWindow:
      made = Windows(rng);
      break;
    case FalseEntrance::kFurniture:
      made = Furniture(rng);
      break;
    case FalseEntrance::kShelf:
      made = Shelf(rng);
      break;
    case FalseEntrance::kSlope:
      made = Slope(rng);
      break;
    case FalseEntrance::kSeat:
      made = Seat(rng);
      break;
    case FalseEntrance::kStack:
      made = Stack(rng);
      break;
  }
  made.plan.id = "00001-False";
  return made;
}

}  // namespace crossnav::evaluation
