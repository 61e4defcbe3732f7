// SPDX-License-Identifier: MIT
#include "crossnav/world/house/embedded_house.h"

#include <numbers>

#include "crossnav/core/check.h"
#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/scene/scene_writer.h"
#include "crossnav/world/shell/architecture.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {
namespace {

// Walls' centre lines: three bays in x, the hall with the stair in the middle.
constexpr double kWest = 0, kHallWest = 3.8, kHallEast = 6.2, kEast = 10;
constexpr double kSouth = 0, kWestSplit = 5.2, kEastSplit = 4.6, kNorth = 9;
constexpr double kStairX = 4.36, kStairY = 2.0;  // first riser, middle of the flight
using std::numbers::pi;

Room MakeRoom(const char* name, RoomType type, int level, const Rect& rect) {
  Room room;
  room.name = name;
  room.type = type;
  room.level = level;
  room.rects = {rect};
  const bool is_wet = type == RoomType::kBathroom || type == RoomType::kKitchen;
  room.floor = is_wet ? SurfaceFinish{{176, 178, 174}, Pattern::kTiles}
                      : SurfaceFinish{{168, 128, 88}, Pattern::kPlanks};
  if (type == RoomType::kBedroom) room.floor = {{150, 142, 132}, Pattern::kCarpet};
  room.wall = {{226, 220, 208}, Pattern::kPlaster};
  if (type == RoomType::kBedroom) room.wall = {{204, 212, 216}, Pattern::kPlaster};
  if (type == RoomType::kBathroom) room.wall = {{206, 220, 220}, Pattern::kTiles};
  room.ceiling = {{242, 242, 240}, Pattern::kPlaster};
  return room;
}

enum RoomIndex {
  kLivingRoom,
  kKitchenRoom,
  kHallBelow,
  kDiningRoom,
  kOfficeRoom,
  kBedroomOne,
  kBedroomTwo,
  kHallAbove,
  kLibrary,
  kBathRoom
};

void AddRooms(HousePlan& plan) {
  const Rect west_south{kWest, kSouth, kHallWest, kWestSplit};
  const Rect west_north{kWest, kWestSplit, kHallWest, kNorth};
  const Rect hall{kHallWest, kSouth, kHallEast, kNorth};
  const Rect east_south{kHallEast, kSouth, kEast, kEastSplit};
  const Rect east_north{kHallEast, kEastSplit, kEast, kNorth};
  plan.rooms = {MakeRoom("living room", RoomType::kLiving, 0, west_south),
                MakeRoom("kitchen", RoomType::kKitchen, 0, west_north),
                MakeRoom("hall", RoomType::kHall, 0, hall),
                MakeRoom("dining room", RoomType::kDining, 0, east_south),
                MakeRoom("office", RoomType::kOffice, 0, east_north),
                MakeRoom("bedroom", RoomType::kBedroom, 1, west_south),
                MakeRoom("bedroom", RoomType::kBedroom, 1, west_north),
                MakeRoom("upper hall", RoomType::kHall, 1, hall),
                MakeRoom("library", RoomType::kOffice, 1, east_south),
                MakeRoom("bathroom", RoomType::kBathroom, 1, east_north)};
}

Opening Window(double center_m, double width_m) {
  return {OpeningKind::kWindow, center_m, width_m, 0.9, 2.1};
}

Opening Door(double center_m, OpeningKind kind = OpeningKind::kDoorway) {
  Opening o;
  o.kind = kind;
  o.center_m = center_m;
  return o;
}

struct WallSides {
  int left, right;  ///< rooms, -1 = outside
};

void AddWall(HousePlan& plan, int level, const Vector2d& a, const Vector2d& b, WallSides sides,
             std::vector<Opening> openings) {
  Wall wall;
  wall.level = level;
  wall.a = a;
  wall.b = b;
  const SurfaceFinish outside{{196, 178, 156}, Pattern::kBrick};
  const auto finish = [&](int room) {
    return room < 0 ? outside : plan.rooms[static_cast<std::size_t>(room)].wall;
  };
  wall.left = finish(sides.left);
  wall.right = finish(sides.right);
  wall.room = sides.left >= 0 ? sides.left : sides.right;
  wall.openings = std::move(openings);
  plan.walls.push_back(std::move(wall));
}

/// Rooms of a level in the order west south, west north, hall, east south, east north.
void AddWalls(HousePlan& plan, int level) {
  const int ws = level * 5, wn = ws + 1, hall = ws + 2, es = ws + 3, en = ws + 4;
  const Vector2d sw(kWest, kSouth), nw(kWest, kNorth), se(kEast, kSouth), ne(kEast, kNorth);
  constexpr double t = 0.06;  // half a wall, so that corners close
  // Outer walls, counter-clockwise: the inside is on the left.
  AddWall(plan, level, sw + Vector2d(-t, 0), {kHallWest, kSouth}, {ws, -1}, {Window(2.0, 1.6)});
  AddWall(plan, level, {kHallWest, kSouth}, {kHallEast, kSouth}, {hall, -1},
          {level == 0 ? Door(1.2, OpeningKind::kDoorClosed) : Window(1.2, 1.0)});
  AddWall(plan, level, {kHallEast, kSouth}, se + Vector2d(t, 0), {es, -1}, {Window(1.9, 1.6)});
  AddWall(plan, level, se, {kEast, kEastSplit}, {es, -1}, {Window(2.3, 1.4)});
  AddWall(plan, level, {kEast, kEastSplit}, ne, {en, -1}, {Window(2.2, 1.0)});
  AddWall(plan, level, ne + Vector2d(t, 0), {kHallEast, kNorth}, {en, -1}, {Window(1.9, 1.0)});
  AddWall(plan, level, {kHallEast, kNorth}, {kHallWest, kNorth}, {hall, -1}, {Window(1.2, 1.2)});
  AddWall(plan, level, {kHallWest, kNorth}, nw + Vector2d(-t, 0), {wn, -1}, {Window(1.9, 1.4)});
  AddWall(plan, level, nw, {kWest, kWestSplit}, {wn, -1}, {Window(1.9, 1.2)});
  AddWall(plan, level, {kWest, kWestSplit}, sw, {ws, -1}, {Window(2.6, 1.6)});
  // Inner walls. Doors in the hall's west wall keep clear of the stair (y 2 to 6.2).
  AddWall(plan, level, {kHallWest, kSouth}, {kHallWest, kWestSplit}, {ws, hall}, {Door(1.1)});
  AddWall(plan, level, {kHallWest, kWestSplit}, {kHallWest, kNorth}, {wn, hall},
          {Door(2.4, level == 0 ? OpeningKind::kDoorway : OpeningKind::kDoorOpen)});
  AddWall(plan, level, {kHallEast, kSouth}, {kHallEast, kEastSplit}, {hall, es}, {Door(1.6)});
  Opening bath = Door(2.9, level == 0 ? OpeningKind::kDoorway : OpeningKind::kDoorOpen);
  bath.opens_left = false;
  AddWall(plan, level, {kHallEast, kEastSplit}, {kHallEast, kNorth}, {hall, en}, {bath});
  AddWall(plan, level, {kWest, kWestSplit}, {kHallWest, kWestSplit}, {wn, ws}, {});
  AddWall(plan, level, {kHallEast, kEastSplit}, {kEast, kEastSplit}, {en, es}, {});
}

void Put(HousePlan& plan, const char* kind, int room, const Vector3d& p_room, double yaw_rad) {
  Rng rng(MixSeed(HashString(kind), plan.furniture.size()));
  auto model = MakeFurniture(kind, rng);
  CROSSNAV_CHECK(model.has_value(), kind);
  const int level = plan.rooms[static_cast<std::size_t>(room)].level;
  const Vector3d ground(0, 0, plan.levels[static_cast<std::size_t>(level)].floor_m);
  plan.furniture.push_back({std::move(*model), StandAt(p_room + ground, yaw_rad), room});
}

/// Puts `kind` on the top of the last placed object.
void PutOnTop(HousePlan& plan, const char* kind, const Vector3d& offset, double yaw_rad) {
  const Placement& below = plan.furniture.back();
  const Vector3d p = below.T_world_object.translation();
  const int room = below.room;
  const int level = plan.rooms[static_cast<std::size_t>(room)].level;
  const double ground = plan.levels[static_cast<std::size_t>(level)].floor_m;
  Put(plan, kind, room, p + offset + Vector3d(0, 0, below.model.top_m - ground), yaw_rad);
}

constexpr double kToNorth = 0, kToWest = pi / 2, kToSouth = pi, kToEast = -pi / 2;

void FurnishBelow(HousePlan& plan) {
  Put(plan, "couch", kLivingRoom, {0.56, 2.6, 0}, kToEast);
  Put(plan, "coffee table", kLivingRoom, {1.75, 2.6, 0}, kToEast);
  Put(plan, "rug", kLivingRoom, {1.75, 2.6, 0}, kToEast);
  Put(plan, "tv stand", kLivingRoom, {3.5, 3.3, 0}, kToWest);
  PutOnTop(plan, "tv", {0, 0, 0}, kToWest);
  Put(plan, "armchair", kLivingRoom, {1.4, 4.5, 0}, kToSouth);
  Put(plan, "potted plant", kLivingRoom, {0.5, 0.55, 0}, 0.3);
  Put(plan, "floor lamp", kLivingRoom, {0.45, 4.7, 0}, 0);
  for (int i = 0; i < 3; ++i) {
    Put(plan, "kitchen cabinet", kKitchenRoom, {0.45 + 0.6 * i, 8.62, 0}, kToSouth);
  }
  Put(plan, "stove", kKitchenRoom, {2.25, 8.62, 0}, kToSouth);
  Put(plan, "refrigerator", kKitchenRoom, {3.38, 8.58, 0}, kToSouth);
  Put(plan, "sink", kKitchenRoom, {0.4, 6.6, 0}, kToEast);
  Put(plan, "kitchen cabinet", kKitchenRoom, {0.4, 5.9, 0}, kToEast);
  Put(plan, "stool", kKitchenRoom, {2.6, 5.75, 0}, 0);
  Put(plan, "chest of drawers", kHallBelow, {5.9, 5.0, 0}, kToWest);
  Put(plan, "dining table", kDiningRoom, {8.2, 2.5, 0}, kToNorth);
  Put(plan, "dining chair", kDiningRoom, {7.85, 1.65, 0}, kToNorth);
  Put(plan, "dining chair", kDiningRoom, {8.55, 1.65, 0}, kToNorth);
  Put(plan, "dining chair", kDiningRoom, {7.85, 3.35, 0}, kToSouth);
  Put(plan, "dining chair", kDiningRoom, {8.55, 3.35, 0}, kToSouth);
  Put(plan, "bookcase", kDiningRoom, {9.0, 4.36, 0}, kToSouth);
  Put(plan, "desk", kOfficeRoom, {9.58, 7.2, 0}, kToWest);
  PutOnTop(plan, "laptop", {-0.05, 0, 0}, kToWest);
  Put(plan, "chair", kOfficeRoom, {8.85, 7.2, 0}, kToEast);
  Put(plan, "bench", kOfficeRoom, {7.6, 4.9, 0}, kToNorth);
}

void FurnishAbove(HousePlan& plan) {
  Put(plan, "bed", kBedroomOne, {1.15, 3.4, 0}, kToEast);
  Put(plan, "bedside table", kBedroomOne, {0.3, 4.75, 0}, kToEast);
  Put(plan, "wardrobe", kBedroomOne, {3.42, 4.0, 0}, kToWest);
  Put(plan, "chest of drawers", kBedroomOne, {0.9, 0.36, 0}, kToNorth);
  Put(plan, "bed", kBedroomTwo, {1.6, 7.85, 0}, kToSouth);
  Put(plan, "bedside table", kBedroomTwo, {0.4, 8.7, 0}, kToSouth);
  Put(plan, "potted plant", kBedroomTwo, {3.35, 5.7, 0}, 0.5);
  Put(plan, "bookcase", kLibrary, {7.2, 4.36, 0}, kToSouth);
  Put(plan, "bookcase", kLibrary, {9.78, 3.4, 0}, kToWest);
  Put(plan, "desk", kLibrary, {8.4, 0.48, 0}, kToNorth);
  Put(plan, "rug", kLibrary, {8.1, 2.4, 0}, 0);
  Put(plan, "potted plant", kLibrary, {9.5, 0.6, 0}, 0.9);
  Put(plan, "bench", kLibrary, {8.6, 4.3, 0}, kToSouth);
  Put(plan, "toilet", kBathRoom, {9.52, 5.6, 0}, kToWest);
  Put(plan, "washbasin", kBathRoom, {9.68, 6.9, 0}, kToWest);
  Put(plan, "bathtub", kBathRoom, {7.3, 8.5, 0}, kToSouth);
  Put(plan, "shower", kBathRoom, {9.42, 8.42, 0}, kToSouth);
  Put(plan, "bench", kHallAbove, {5.0, 8.7, 0}, kToSouth);
}

}  // namespace

HousePlan EmbeddedHousePlan() {
  HousePlan plan;
  plan.id = kEmbeddedSceneId;
  plan.levels = {{0.0, 2.5}, {2.8, 5.3}};
  AddRooms(plan);
  AddWalls(plan, 0);
  AddWalls(plan, 1);
  StairParams stair;
  plan.stairs.push_back(Moved(MakeStraightStair(stair), {kStairX, kStairY, 0}, 1));
  plan.stairs.back().room = kHallBelow;
  RailVoids(plan, 0);
  FurnishBelow(plan);
  FurnishAbove(plan);
  return plan;
}

Result<std::filesystem::path> WriteEmbeddedHouse(const std::filesystem::path& dir) {
  return WriteScene(BuildHouse(EmbeddedHousePlan()), dir);
}

}  // namespace crossnav::world
