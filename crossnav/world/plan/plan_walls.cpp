// SPDX-License-Identifier: MIT
#include "crossnav/world/plan/plan_walls.h"

#include <algorithm>
#include <cmath>

namespace crossnav::world {
namespace {

constexpr double kProbe_m = 0.01;

/// Rooms that are open to an adjacent void.
bool IsOpenToVoid(RoomType type) {
  return type == RoomType::kHall || type == RoomType::kStairwell || type == RoomType::kMezzanine;
}

bool NeedsWall(const HousePlan& plan, int a, int b) {
  if (a == b) return false;
  const auto type = [&](int room) { return plan.rooms[static_cast<std::size_t>(room)].type; };
  if (a < 0 || b < 0) return type(std::max(a, b)) != RoomType::kBalcony;
  const int group = plan.rooms[static_cast<std::size_t>(a)].open_group;
  if (group >= 0 && group == plan.rooms[static_cast<std::size_t>(b)].open_group) return false;
  if (type(a) == RoomType::kVoid) return !IsOpenToVoid(type(b));
  if (type(b) == RoomType::kVoid) return !IsOpenToVoid(type(a));
  return true;
}

std::vector<double> Sorted(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end(), [](double a, double b) { return b - a < 1e-6; }),
          v.end());
  return v;
}

struct Deriver {
  HousePlan& plan;
  const SurfaceFinish& outside;
  int level;
  std::vector<double> xs, ys;

  SurfaceFinish FinishOf(int room) const {
    if (room < 0) return outside;
    const Room& r = plan.rooms[static_cast<std::size_t>(room)];
    return r.type == RoomType::kBalcony ? outside : r.wall;
  }
  double OffsetOf(int room) const {
    return room < 0 ? 0.0 : std::min(0.0, plan.rooms[static_cast<std::size_t>(room)].offset_m);
  }

  /// Adds a wall from s0 to s1 along the line; `left` and `right` as seen from a to b.
  void Add(bool vertical, double fixed, double s0, double s1, int left, int right) {
    Wall wall;
    wall.level = level;
    const double extend = 0.5 * wall.thickness_m;  // closes the corners
    wall.a = vertical ? Vector2d(fixed, s0 - extend) : Vector2d(s0 - extend, fixed);
    wall.b = vertical ? Vector2d(fixed, s1 + extend) : Vector2d(s1 + extend, fixed);
    wall.left = FinishOf(left);
    wall.right = FinishOf(right);
    wall.room = left >= 0 ? left : right;
    wall.other_room = left >= 0 ? right : left;
    wall.base_m = std::min(OffsetOf(left), OffsetOf(right));
    plan.walls.push_back(std::move(wall));
  }

  /// Rooms on both sides of a place on a line, as seen from a to b; empty without a wall.
  struct Sides {
    bool is_wall = false;
    int left = -1, right = -1;
    bool operator==(const Sides&) const = default;
  };
  Sides SidesAt(bool vertical, double fixed, double along) const {
    const double off = vertical ? -kProbe_m : kProbe_m;
    const auto room_at = [&](double across) {
      return RoomAt(plan, level, vertical ? Vector2d(across, along) : Vector2d(along, across));
    };
    const Sides sides{true, room_at(fixed + off), room_at(fixed - off)};
    return NeedsWall(plan, sides.left, sides.right) ? sides : Sides();
  }

  /// Walls on a line: a wall extends as long as both its rooms are the same.
  void AlongLine(bool vertical, double fixed) {
    const auto& along = vertical ? ys : xs;
    double start = 0;
    Sides open;
    for (std::size_t i = 0; i < along.size(); ++i) {
      const bool is_end = i + 1 == along.size();
      const Sides sides =
          is_end ? Sides() : SidesAt(vertical, fixed, 0.5 * (along[i] + along[i + 1]));
      if (sides == open) continue;
      if (open.is_wall) Add(vertical, fixed, start, along[i], open.left, open.right);
      open = sides;
      start = along[i];
    }
  }

  void Along(bool vertical) {
    for (const double fixed : vertical ? xs : ys) AlongLine(vertical, fixed);
  }
};

}  // namespace

int RoomAt(const HousePlan& plan, int level, const Vector2d& p) {
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    if (plan.rooms[i].level != level) continue;
    for (const Rect& r : plan.rooms[i].rects) {
      if (r.Contains(p)) return static_cast<int>(i);
    }
  }
  return -1;
}

void DeriveWalls(HousePlan& plan, const SurfaceFinish& outside) {
  for (int level = 0; level < static_cast<int>(plan.levels.size()); ++level) {
    Deriver deriver{plan, outside, level, {}, {}};
    for (const Room& room : plan.rooms) {
      if (room.level != level) continue;
      for (const Rect& r : room.rects) {
        deriver.xs.insert(deriver.xs.end(), {r.x0, r.x1});
        deriver.ys.insert(deriver.ys.end(), {r.y0, r.y1});
      }
    }
    deriver.xs = Sorted(deriver.xs);
    deriver.ys = Sorted(deriver.ys);
    deriver.Along(true);
    deriver.Along(false);
  }
}

Wall* FindWall(HousePlan& plan, int room_a, int room_b) {
  Wall* best = nullptr;
  for (Wall& wall : plan.walls) {
    const bool is_pair = (wall.room == room_a && wall.other_room == room_b) ||
                         (wall.room == room_b && wall.other_room == room_a);
    if (is_pair && (!best || (wall.b - wall.a).norm() > (best->b - best->a).norm())) best = &wall;
  }
  return best;
}

bool AddOpening(Wall& wall, const Opening& opening) {
  constexpr double kMargin_m = 0.2;  // chosen: a pier between openings and at the wall's ends
  const double length = (wall.b - wall.a).norm();
  const double lo = opening.center_m - 0.5 * opening.width_m;
  const double hi = opening.center_m + 0.5 * opening.width_m;
  if (lo < kMargin_m || hi > length - kMargin_m) return false;
  for (const Opening& o : wall.openings) {
    if (lo < o.center_m + 0.5 * o.width_m + kMargin_m &&
        hi > o.center_m - 0.5 * o.width_m - kMargin_m) {
      return false;
    }
  }
  wall.openings.push_back(opening);
  return true;
}

}  // namespace crossnav::world
