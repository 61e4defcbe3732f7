// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/house_plan.h"

#include <algorithm>
#include <cmath>

#include "crossnav/world/layout/edition.h"
#include "crossnav/world/layout/house_shapes.h"
#include "crossnav/world/layout/layout.h"
#include "crossnav/world/layout/mezzanine.h"
#include "crossnav/world/layout/open_plan.h"
#include "crossnav/world/layout/plan_turn.h"
#include "crossnav/world/layout/room_types.h"
#include "crossnav/world/plan/plan_walls.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {
namespace {

struct Draft {
  const HouseParams& params;
  Rng& rng;
  HouseLayout layout;
  HousePlan plan;
  int ground = 0;                                ///< level of the front door
  std::vector<int> hall_of_level;                ///< room index
  std::vector<std::vector<int>> rooms_of_level;  ///< room index per cell
  bool is_good = true;

  void DrawLevels(int levels, double slab_m, LayoutParams& out) {
    double z = 0;
    for (int k = 0; k < levels; ++k) {
      const double clear_m = 2.3 + 0.05 * rng.Int(0, 12);  // 2.3 to 2.9
      plan.levels.push_back({z, z + clear_m});
      z += clear_m + slab_m;
      if (k + 1 < levels) out.rises_m.push_back(clear_m + slab_m);
    }
  }

  int AddRoom(RoomType type, int level, std::vector<Rect> rects) {
    Room room;
    room.type = type;
    room.name = NameOf(type);
    room.level = level;
    room.rects = std::move(rects);
    DrawFinishes(room, rng);
    plan.rooms.push_back(std::move(room));
    return static_cast<int>(plan.rooms.size()) - 1;
  }

  LevelRole RoleOf(int level) const {
    if (params.building == Building::kOffice) return LevelRole::kOffice;
    if (level < ground) return LevelRole::kBasement;
    if (plan.levels.size() == 1) return LevelRole::kOnly;
    return level == ground ? LevelRole::kGround : LevelRole::kUpper;
  }

  void AddRooms(int level) {
    const LevelLayout& cells = layout.levels[static_cast<std::size_t>(level)];
    std::vector<Rect> hall = {cells.corridor};
    for (const Shaft& s : layout.shafts) {
      if (!s.is_enclosed && s.lo <= level && level <= s.hi) hall.push_back(RectOf(layout, s));
    }
    hall_of_level.push_back(AddRoom(RoomType::kHall, level, hall));
    const auto types = DrawRoomTypes(cells, RoleOf(level), rng);
    std::vector<int> rooms;
    for (std::size_t i = 0; i < cells.cells.size(); ++i) {
      rooms.push_back(AddRoom(types[i], level, {cells.cells[i].rect}));
      if (types[i] == RoomType::kVoid) AddVoid(rooms.back());
    }
    rooms_of_level.push_back(rooms);
    if (!Draws(edition.open_plan_chance, rng)) return;
    std::vector<int> joinable;  // a room across the corridor's end may be sunken
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      if (!cells.cells[i].is_end_room) joinable.push_back(rooms[i]);
    }
    OpenLevel(plan, joinable, hall_of_level.back(), rng);
  }

  void AddVoid(int room) {
    const auto at = static_cast<std::size_t>(room);
    const int level = plan.rooms[at].level;
    const Rect open = plan.rooms[at].rects[0];
    VoidPlace place{room, -1, open.y0 >= layout.corridor_y1 - 1e-6,
                    plan.levels[static_cast<std::size_t>(level)].floor_m -
                        plan.levels[static_cast<std::size_t>(level) - 1].ceiling_m};
    for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
      Room& below = plan.rooms[i];  // the same cell of the level below loses its ceiling
      if (below.level != level - 1 || !(below.rects[0] == open)) continue;
      below.has_ceiling = false;
      place.below_room = static_cast<int>(i);
    }
    if (Draws(edition.mezzanine_chance, rng)) {
      const Mezzanine made = AddMezzanine(plan, place, rng);
      if (made.room >= 0 && !made.has_own_stair) mezzanines.push_back(made.room);
    }
    plan.voids.emplace_back(level, plan.rooms[at].rects[0]);
  }

  void AddStairs() {
    for (const Shaft& shaft : layout.shafts) {
      for (int level = shaft.lo; level < shaft.hi; ++level) {
        const auto k = static_cast<std::size_t>(level);
        const double z = plan.levels[k].floor_m, rise = plan.levels[k + 1].floor_m - z;
        Stair stair = Moved(StairIn(layout, shaft, level, rise).stair, {0, 0, z}, 0);
        stair.lower_level = level;
        stair.upper_level = level + 1;
        stair.room = hall_of_level[k];
        DrawStairFinish(stair);
        plan.stairs.push_back(std::move(stair));
      }
    }
  }

  void DrawStairFinish(Stair& stair) {
    static constexpr Rgb8 kLooks[] = {{150, 110, 75},  {104, 74, 52},   {196, 190, 180},
                                      {120, 122, 126}, {176, 140, 100}, {140, 60, 54}};
    stair.finish = {kLooks[rng.Below(std::size(kLooks))], Pattern::kPlain};
  }

  /// Enclosed stairwells become rooms before the walls are derived.
  std::vector<std::pair<int, const Shaft*>> AddStairwells() {
    std::vector<std::pair<int, const Shaft*>> made;
    for (const Shaft& s : layout.shafts) {
      if (!s.is_enclosed) continue;
      for (int level = s.lo; level <= s.hi; ++level) {
        made.emplace_back(AddRoom(RoomType::kStairwell, level, {RectOf(layout, s)}), &s);
      }
    }
    return made;
  }

  void OpenStairwell(int room, const Shaft& shaft) {
    const int level = plan.rooms[static_cast<std::size_t>(room)].level;
    // The longest wall may border an open stair beside it, which is part of the hall.
    Wall* wall = edition.number > 1
                     ? FindCorridorWall(room)
                     : FindWall(plan, room, hall_of_level[static_cast<std::size_t>(level)]);
    if (!wall) {
      is_good = false;
      return;
    }
    const auto open = [&](double x0, double x1, bool has_door) {
      Opening o;
      o.kind = has_door ? OpeningKind::kDoorOpen : OpeningKind::kPassage;
      o.width_m = 0.8;
      o.center_m = std::abs(0.5 * (x0 + x1) - wall->a.x());
      const bool hall_is_left = wall->room == hall_of_level[static_cast<std::size_t>(level)];
      o.opens_left = hall_is_left;  // away from the steps
      is_good = AddOpening(*wall, o) && is_good;
    };
    const bool has_door = shaft.params.kind == StairKind::kBasement;
    if (level < shaft.hi) {
      const StairBlock b = StairIn(layout, shaft, level, shaft.params.rise_m);
      open(b.entry_x0, b.entry_x1, shaft.params.kind == StairKind::kAttic);
    }
    if (level > shaft.lo) {
      const StairBlock b = StairIn(layout, shaft, level - 1, shaft.params.rise_m);
      open(b.exit_x0, b.exit_x1, has_door);
    }
  }

  std::size_t LevelOf(int room) const {
    return static_cast<std::size_t>(plan.rooms[static_cast<std::size_t>(room)].level);
  }

  /// Part of the wall, from its `a`, on the edge of its level's corridor.
  Range AlongCorridor(const Wall& w) const {
    const Rect near = layout.levels[static_cast<std::size_t>(w.level)].corridor.Grown(0.1);
    const Vector2d d = (w.b - w.a).normalized();
    const Rect line{w.a.x(), w.a.y(), w.b.x(), w.b.y()};
    const Rect shared = line.Shared(near);
    if (shared.x1 < shared.x0 || shared.y1 < shared.y0) return {};
    return {d.dot(Vector2d(shared.x0, shared.y0) - w.a),
            d.dot(Vector2d(shared.x1, shared.y1) - w.a)};
  }

  /// The longest wall of `room` along the corridor; doors into a stair shaft are excluded.
  Wall* FindCorridorWall(int room) {
    const Rect near = layout.levels[LevelOf(room)].corridor.Grown(0.1);
    const int hall = hall_of_level[LevelOf(room)];
    Wall* best = nullptr;
    for (Wall& w : plan.walls) {
      const bool is_pair =
          (w.room == room && w.other_room == hall) || (w.room == hall && w.other_room == room);
      // Edition 2 also accepts a wall that continues beside an open stair.
      const bool is_along = edition.number > 1 ? AlongCorridor(w).hi - AlongCorridor(w).lo > 1.1
                                               : near.Contains(w.a) && near.Contains(w.b);
      if (!is_pair || !is_along) continue;
      if (!best || (w.b - w.a).norm() > (best->b - best->a).norm()) best = &w;
    }
    return best;
  }

  /// Adds a door or passage in the wall between two rooms.
  bool Connect(int from, int to) {
    if (IsOpenBetween(plan, from, to)) return true;
    Wall* wall =
        from == hall_of_level[LevelOf(to)] ? FindCorridorWall(to) : FindWall(plan, from, to);
    if (!wall) return false;
    const bool is_clipped = edition.number > 1 && from == hall_of_level[LevelOf(to)];
    const Range span = is_clipped ? AlongCorridor(*wall) : Range{0, (wall->b - wall->a).norm()};
    const RoomType type = plan.rooms[static_cast<std::size_t>(to)].type;
    const bool is_common =
        type == RoomType::kLiving || type == RoomType::kDining || type == RoomType::kKitchen;
    for (int attempt = 0; attempt < 30; ++attempt) {
      Opening o;
      const double draw = rng.Uniform();
      if (is_common && draw < 0.35) {
        o.kind = OpeningKind::kPassage;
        o.width_m = rng.Uniform(1.1, 2.0);
        o.head_m = 2.1;
      } else {
        o.kind = draw < 0.55   ? OpeningKind::kDoorway
                 : draw < 0.85 ? OpeningKind::kDoorOpen
                               : OpeningKind::kDoorAjar;
        o.width_m = edition.door_m.Draw(rng);
        if (o.kind == OpeningKind::kDoorAjar && edition.ajar_deg.lo < edition.ajar_deg.hi) {
          o.ajar_deg = edition.ajar_deg.Draw(rng);
        }
        if (Draws(edition.threshold_chance, rng)) o.threshold_m = rng.Uniform(0.015, 0.06);
      }
      o.center_m = span.Draw(rng);
      const bool is_beside =
          o.center_m - 0.5 * o.width_m < span.lo || o.center_m + 0.5 * o.width_m > span.hi;
      if (is_clipped && is_beside) continue;
      o.hinge_at_a = rng.Chance(0.5);
      o.opens_left = (wall->room == to);  // into the room
      if (AddOpening(*wall, o)) return true;
    }
    return false;
  }

  void AddDoors(int level) {
    const auto k = static_cast<std::size_t>(level);
    const auto& cells = layout.levels[k].cells;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].is_void) continue;
      const int from = cells[i].parent < 0
                           ? hall_of_level[k]
                           : rooms_of_level[k][static_cast<std::size_t>(cells[i].parent)];
      is_good = Connect(from, rooms_of_level[k][i]) && is_good;
    }
    for (const int room : mezzanines) {
      if (LevelOf(room) == k) is_good = Connect(hall_of_level[k], room) && is_good;
    }
    if (level != ground) return;
    Opening front;
    front.kind = OpeningKind::kDoorClosed;
    for (Wall& wall : plan.walls) {  // the corridor's end at x = 0
      const bool is_front = wall.room == hall_of_level[k] && wall.other_room < 0 &&
                            std::abs(wall.a.x()) < 1e-6 && std::abs(wall.b.x()) < 1e-6;
      if (!is_front) continue;
      front.center_m = 0.5 * (wall.b - wall.a).norm();
      AddOpening(wall, front);
    }
  }

  bool IsOnFacade(const Wall& wall) const {
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-6; };
    const bool vertical = near(wall.a.x(), wall.b.x());
    return vertical ? near(wall.a.x(), 0) || near(wall.a.x(), layout.width_m)
                    : near(wall.a.y(), 0) || near(wall.a.y(), layout.depth_m);
  }

  void AddWindows() {
    for (Wall& wall : plan.walls) {
      if (wall.other_room >= 0 || !IsOnFacade(wall) || wall.level < ground) continue;
      const RoomType type = plan.rooms[static_cast<std::size_t>(wall.room)].type;
      const double length = (wall.b - wall.a).norm();
      if (type == RoomType::kStorage && rng.Chance(0.6)) continue;
      const int count = std::max(1, static_cast<int>(length / rng.Uniform(2.4, 3.4)));
      for (int i = 0; i < count; ++i) {
        Opening o;
        o.kind = OpeningKind::kWindow;
        const bool is_small = type == RoomType::kBathroom || type == RoomType::kWc;
        o.width_m = is_small ? rng.Uniform(0.5, 0.8) : rng.Uniform(0.8, 1.7);
        o.sill_m = is_small ? 1.3 : rng.Uniform(0.75, 1.0);
        if (type == RoomType::kKitchen) o.sill_m += 0.3;  // over the worktop
        o.head_m = std::min(2.15, rng.Uniform(2.0, 2.2));
        o.center_m = length * (i + 0.5) / count + rng.Uniform(-0.2, 0.2);
        if (type == RoomType::kVoid) o.sill_m = 0.6;
        AddOpening(wall, o);
      }
    }
  }

  /// A platform outside an upper room, with railings, sometimes open on one side: a false stair
  /// entrance.
  void AddBalcony(int level) {
    const auto k = static_cast<std::size_t>(level);
    for (std::size_t i = 0; i < rooms_of_level[k].size(); ++i) {
      const Room room = plan.rooms[static_cast<std::size_t>(rooms_of_level[k][i])];
      const Rect r = room.rects[0];
      if (room.type != RoomType::kBedroom && room.type != RoomType::kLiving) continue;
      const bool is_south = r.y0<1e-6, is_north = r.y1> layout.depth_m - 1e-6;
      if ((!is_south && !is_north) || r.Width() < 3.0) continue;
      const double depth = rng.Uniform(1.1, 1.6), width = rng.Uniform(2.2, r.Width() - 0.6);
      const double x0 = r.x0 + 0.5 * (r.Width() - width);
      const Rect out = is_south ? Rect{x0, -depth, x0 + width, 0.0}
                                : Rect{x0, layout.depth_m, x0 + width, layout.depth_m + depth};
      const int balcony = AddRoom(RoomType::kBalcony, level, {out});
      plan.rooms.back().has_ceiling = false;
      balconies.push_back({balcony, rooms_of_level[k][i]});
      const double z = plan.levels[k].floor_m, edge = is_south ? out.y0 : out.y1;
      const double wall = is_south ? out.y1 : out.y0;
      const int style = rng.Int(0, 2);
      plan.railings.push_back({{out.x0, edge, z}, {out.x1, edge, z}, 0.95, style});
      plan.railings.push_back({{out.x0, edge, z}, {out.x0, wall, z}, 0.95, style});
      if (rng.Chance(0.7)) {
        plan.railings.push_back({{out.x1, edge, z}, {out.x1, wall, z}, 0.95, style});
      }
      return;
    }
  }

  void OpenBalconies() {
    for (const auto& [balcony, room] : balconies) {
      Wall* wall = FindWall(plan, balcony, room);
      if (!wall) continue;
      Opening o;
      o.width_m = 0.9;
      o.center_m = 0.5 * (wall->b - wall->a).norm();
      is_good = AddOpening(*wall, o) && is_good;
    }
  }

  /// Three to seven steps down into the room across the corridor's end.
  void SinkEndRoom() {
    const auto& level = layout.levels[0];
    for (std::size_t i = 0; i < level.cells.size(); ++i) {
      if (!level.cells[i].is_end_room) continue;
      const int risers = rng.Int(3, 7);
      const double riser_m = rng.Uniform(0.15, 0.18), tread_m = rng.Uniform(0.27, 0.32);
      const double run_m = (risers - 1) * tread_m;
      if (level.cells[i].rect.Width() < run_m + 2.2) return;
      const int room_index = rooms_of_level[0][i];
      Room& room = plan.rooms[static_cast<std::size_t>(room_index)];
      room.offset_m = -risers * riser_m;
      const Rect& corridor = level.corridor;
      const double width = corridor.Depth() - 0.2, y = corridor.Center().y();
      Stair steps = Moved(MakeSteps(risers * riser_m, risers, tread_m, width),
                          {corridor.x1 + run_m, y, room.offset_m}, 2);
      steps.lower_level = steps.upper_level = 0;
      steps.room = room_index;
      DrawStairFinish(steps);
      plan.stairs.push_back(std::move(steps));
      return;
    }
  }

  std::vector<std::pair<int, int>> balconies;
  std::vector<int> mezzanines = {};  ///< entered from the hall
  const Edition& edition = EditionOf(params.edition);
};

}  // namespace

Result<HousePlan> DrawHousePlan(const HouseParams& params, Rng& rng) {
  const Edition& edition = EditionOf(params.edition);
  LayoutParams lp;
  lp.edition = params.edition;
  lp.levels = params.floors;
  lp.area_m2 = params.area_m2;
  lp.slab_m = 0.01 * rng.Int(20, 30);
  lp.has_basement = lp.levels >= 2 && rng.Chance(0.3);
  lp.is_office = params.building == Building::kOffice;
  if (lp.is_office) lp.has_basement = false;
  lp.has_attic =
      !lp.is_office && lp.levels >= (lp.has_basement ? 3 : 2) && Draws(edition.attic_chance, rng);
  Draft draft{params, rng, {}, {}, lp.has_basement ? 1 : 0, {}, {}, true, {}};
  draft.DrawLevels(lp.levels, lp.slab_m, lp);
  auto layout = DrawLayout(lp, rng);
  if (!layout) return Fail(ErrorCode::kInvalid, "no stair fits this floor plan");
  draft.layout = std::move(*layout);
  for (int level = 0; level < lp.levels; ++level) draft.AddRooms(level);
  const auto stairwells = draft.AddStairwells();
  draft.AddStairs();
  if (!lp.has_basement && rng.Chance(0.35)) draft.SinkEndRoom();
  for (int level = draft.ground + 1; level < lp.levels; ++level) {
    if (rng.Chance(0.5)) draft.AddBalcony(level);
  }
  const SurfaceFinish outside{{static_cast<std::uint8_t>(rng.Int(150, 220)), 178, 156},
                              Pattern::kBrick};
  DeriveWalls(draft.plan, outside);
  for (const auto& [room, shaft] : stairwells) draft.OpenStairwell(room, *shaft);
  draft.OpenBalconies();
  for (int level = 0; level < lp.levels; ++level) draft.AddDoors(level);
  draft.AddWindows();
  RailVoids(draft.plan, rng.Int(0, 2));
  if (edition.round_chance > 0) RoundRooms(draft.plan, edition.round_chance, rng);
  if (!lp.is_office && Draws(edition.sloping_chance, rng)) {
    SlopeTopLevel(draft.plan, draft.layout.depth_m, rng);
  }
  if (!draft.is_good) return Fail(ErrorCode::kInvalid, "a door finds no place");
  TurnPlan(draft.plan, rng.Int(0, 3));
  return std::move(draft.plan);
}

}  // namespace crossnav::world
