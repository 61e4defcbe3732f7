// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/house_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crossnav::world {
namespace {

constexpr double kIntoSlab_m = 0.02;  // blocks run into the ceiling, so that no gap shows
using std::numbers::pi;

bool IsPlain(const Room& room) {
  using enum RoomType;
  return room.type != kHall && room.type != kStairwell && room.type != kBalcony &&
         room.type != kVoid && room.type != kMezzanine && room.offset_m == 0;
}

/// Whether stairs, voids or openings reach into `rect` on `level`.
bool IsInUse(const HousePlan& plan, int level, const Rect& rect) {
  for (const Rect& v : plan.VoidsOf(level)) {
    if (v.Grown(0.3).Overlaps(rect)) return true;
  }
  for (const Stair& stair : plan.stairs) {
    if (stair.lower_level != level) continue;
    for (const Rect& r : stair.footprint) {
      if (r.Grown(0.9).Overlaps(rect)) return true;
    }
  }
  for (const Wall& wall : plan.walls) {
    if (wall.level != level) continue;
    const Vector2d along = (wall.b - wall.a).normalized();
    for (const Opening& o : wall.openings) {
      const Vector2d c = wall.a + o.center_m * along;
      const Rect at = Rect{c.x(), c.y(), c.x(), c.y()}.Grown(0.5 * o.width_m + 0.15);
      if (at.Overlaps(rect)) return true;
    }
  }
  return false;
}

bool HasWallAt(const HousePlan& plan, int level, const Vector2d& p) {
  return std::any_of(plan.walls.begin(), plan.walls.end(), [&](const Wall& w) {
    const Rect line{std::min(w.a.x(), w.b.x()), std::min(w.a.y(), w.b.y()),
                    std::max(w.a.x(), w.b.x()), std::max(w.a.y(), w.b.y())};
    return w.level == level && line.Grown(0.02).Contains(p);
  });
}

/// From the floor to the ceiling of the room.
Block Prism(const HousePlan& plan, std::size_t room, std::vector<Vector2d> polygon) {
  double area = 0;  // twice the signed area
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    area += a.x() * b.y() - a.y() * b.x();
  }
  if (area < 0) std::reverse(polygon.begin(), polygon.end());
  const Level& level = plan.levels[static_cast<std::size_t>(plan.rooms[room].level)];
  Block block{
      "wall", static_cast<int>(room), {}, level.ceiling_m + kIntoSlab_m, plan.rooms[room].wall};
  for (const Vector2d& p : polygon) block.bottom.emplace_back(p.x(), p.y(), level.floor_m);
  return block;
}

/// Fills the corner outside a quarter circle.
void RoundCorner(HousePlan& plan, std::size_t room, const Vector2d& corner, const Vector2d& inward,
                 double radius_m) {
  constexpr int kPieces = 6;
  const Vector2d center = corner + radius_m * inward;
  const auto at = [&](int i) -> Vector2d {
    const double angle = 0.5 * pi * i / kPieces;
    return center - radius_m * Vector2d(inward.x() * std::sin(angle), inward.y() * std::cos(angle));
  };
  for (int i = 0; i < kPieces; ++i) {
    plan.blocks.push_back(Prism(plan, room, {corner, at(i), at(i + 1)}));
  }
}

void RoundCorners(HousePlan& plan, std::size_t index, Rng& rng) {
  const Rect r = plan.rooms[index].rects[0];
  const int level = plan.rooms[index].level;
  const double most_m = std::min(2.0, 0.42 * std::min(r.Width(), r.Depth()));
  const double radius_m = rng.Uniform(0.6, std::max(0.7, most_m));
  for (const double sx : {1.0, -1.0}) {
    for (const double sy : {1.0, -1.0}) {
      const bool is_wanted = rng.Chance(0.6);
      const Vector2d corner(sx > 0 ? r.x0 : r.x1, sy > 0 ? r.y0 : r.y1), inward(sx, sy);
      const Vector2d far = corner + radius_m * inward;
      const Rect square{std::min(corner.x(), far.x()), std::min(corner.y(), far.y()),
                        std::max(corner.x(), far.x()), std::max(corner.y(), far.y())};
      const bool has_walls =
          HasWallAt(plan, level, {corner.x() + 0.5 * radius_m * sx, corner.y()}) &&
          HasWallAt(plan, level, {corner.x(), corner.y() + 0.5 * radius_m * sy});
      if (!is_wanted || !has_walls || IsInUse(plan, level, square)) continue;
      RoundCorner(plan, index, corner, inward, radius_m);
    }
  }
}

void AddColumn(HousePlan& plan, std::size_t index, Rng& rng) {
  constexpr int kColumnSides = 12;
  const Rect inner = plan.rooms[index].rects[0].Grown(-1.3);
  const Vector2d c = inner.Draw(rng);
  const double radius_m = rng.Uniform(0.12, 0.28);
  const Rect around = Rect{c.x(), c.y(), c.x(), c.y()}.Grown(radius_m + 0.6);
  if (IsInUse(plan, plan.rooms[index].level, around)) return;
  std::vector<Vector2d> circle;
  for (int i = 0; i < kColumnSides; ++i) {
    const double angle = 2 * pi * i / kColumnSides;
    circle.push_back(c + radius_m * Vector2d(std::cos(angle), std::sin(angle)));
  }
  plan.blocks.push_back(Prism(plan, index, std::move(circle)));
  plan.blocks.back().name = "column";
}

/// Wedge between the roof and the ceiling of one room, over the facade at `y0`.
void AddWedge(HousePlan& plan, std::size_t index, const Rect& r, double y0, double knee_m,
              double reach_m) {
  const Level& level = plan.levels[static_cast<std::size_t>(plan.rooms[index].level)];
  const double top_m = level.ceiling_m + kIntoSlab_m, low_m = level.floor_m + knee_m;
  const double y1 = y0 < r.Center().y() ? y0 + reach_m : y0 - reach_m;
  Block block{"ceiling", static_cast<int>(index), {}, top_m, plan.rooms[index].ceiling};
  const double south = std::min(y0, y1), north = std::max(y0, y1);
  const double south_m = y0 < y1 ? low_m : top_m, north_m = y0 < y1 ? top_m : low_m;
  block.bottom = {{r.x0, south, south_m},
                  {r.x1, south, south_m},
                  {r.x1, north, north_m},
                  {r.x0, north, north_m}};
  plan.blocks.push_back(std::move(block));
}

/// Lowers windows of the facade at `y0` to the knee wall, or removes them.
void LowerWindows(HousePlan& plan, int level, double y0, double knee_m) {
  constexpr double kLeast_m = 1.2;  // chosen: a knee wall high enough for a window
  for (Wall& wall : plan.walls) {
    const bool is_facade = wall.level == level && wall.other_room < 0 &&
                           std::abs(wall.a.y() - y0) < 1e-6 && std::abs(wall.b.y() - y0) < 1e-6;
    if (!is_facade) continue;
    std::erase_if(wall.openings, [&](const Opening& o) {
      return o.kind == OpeningKind::kWindow && knee_m < kLeast_m;
    });
    for (Opening& o : wall.openings) {
      if (o.kind != OpeningKind::kWindow) continue;
      o.sill_m = 0.4;
      o.head_m = knee_m - 0.1;
    }
  }
}

}  // namespace

void RoundRooms(HousePlan& plan, double chance, Rng& rng) {
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    if (!IsPlain(plan.rooms[i]) || !rng.Chance(chance)) continue;
    const Rect& r = plan.rooms[i].rects[0];
    const bool is_large = std::min(r.Width(), r.Depth()) > 3.6;
    if (is_large && rng.Chance(0.4)) {
      AddColumn(plan, i, rng);
    } else if (std::min(r.Width(), r.Depth()) > 1.9) {
      RoundCorners(plan, i, rng);
    }
  }
}

void SlopeTopLevel(HousePlan& plan, double depth_m, Rng& rng) {
  const int top = static_cast<int>(plan.levels.size()) - 1;
  for (const double y0 : {0.0, depth_m}) {
    const double knee_m = rng.Uniform(0.8, 1.7), reach_m = rng.Uniform(1.0, 2.4);
    for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
      const Room& room = plan.rooms[i];
      if (room.level != top || !IsPlain(room)) continue;
      const Rect r = room.rects[0];
      const bool touches = std::abs(y0 == 0 ? r.y0 : r.y1 - depth_m) < 1e-6;
      if (touches) AddWedge(plan, i, r, y0, knee_m, std::min(reach_m, 0.45 * r.Depth()));
    }
    LowerWindows(plan, top, y0, knee_m);
  }
}

}  // namespace crossnav::world
