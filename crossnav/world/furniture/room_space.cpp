// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/room_space.h"

#include <algorithm>
#include <cmath>

#include "crossnav/world/furniture/furnish.h"

namespace crossnav::world {
namespace {

constexpr double kOffWall_m = 0.08;  // half a wall and its skirting
constexpr double kDoorHead_m = 2.1;

/// Zone before a window or a door that stays free, from above.
Rect ZoneOf(const Wall& wall, const Opening& o) {
  const Vector2d d = (wall.b - wall.a).normalized(), n(-d.y(), d.x());
  const bool is_window = o.kind == OpeningKind::kWindow;
  const bool has_leaf = o.kind == OpeningKind::kDoorOpen || o.kind == OpeningKind::kDoorAjar;
  const double half = 0.5 * o.width_m + (is_window ? 0.0 : 0.1);
  const double reach = is_window ? 0.25 : (has_leaf ? o.width_m + 0.15 : 0.85);
  const Vector2d c = wall.a + d * o.center_m;
  Rect r{c.x(), c.y(), c.x(), c.y()};
  for (double s : {-1.0, 1.0}) {
    for (double t : {-1.0, 1.0}) {
      const Vector2d p = c + s * half * d + t * reach * n;
      r = {std::min(r.x0, p.x()), std::min(r.y0, p.y()), std::max(r.x1, p.x()),
           std::max(r.y1, p.y())};
    }
  }
  return r;
}

struct SpaceMaker {
  const HousePlan& plan;
  const int level;
  RoomSpace& space;

  void AddOpenings() {
    for (const Wall& wall : plan.walls) {
      if (wall.level != level) continue;
      const double z = plan.levels[static_cast<std::size_t>(wall.level)].floor_m;
      for (const Opening& o : wall.openings) {
        const bool is_window = o.kind == OpeningKind::kWindow;
        space.keep_out.push_back(Solid(ZoneOf(wall, o), is_window ? z + o.sill_m : z - 2,
                                       is_window ? z + o.head_m : z + kDoorHead_m));
      }
    }
  }

  void KeepOut(const Rect& r) {
    space.keep_out.push_back(Solid(r, space.floor_m - 2, space.floor_m + kDoorHead_m));
  }

  void AddStairs() {
    for (const Rect& v : plan.VoidsOf(level)) KeepOut(v.Grown(0.12));
    for (const Stair& stair : plan.stairs) {
      if (stair.lower_level == level) {
        for (const Rect& r : stair.footprint) KeepOut(r.Grown(0.1));
      }
      const auto zone = [&](const std::vector<Edge>& edges) {
        for (const Edge& e : edges) {
          KeepOut(Rect{std::min(e.a.x(), e.b.x()), std::min(e.a.y(), e.b.y()),
                       std::max(e.a.x(), e.b.x()), std::max(e.a.y(), e.b.y())}
                      .Grown(0.8));
        }
      };
      if (stair.lower_level == level) zone(stair.departures);
      if (stair.upper_level == level) zone(stair.arrivals);
    }
    for (const Railing& r : plan.railings) {
      if (std::abs(r.a.z() - space.floor_m) > 0.5) continue;
      KeepOut(Rect{std::min(r.a.x(), r.b.x()), std::min(r.a.y(), r.b.y()),
                   std::max(r.a.x(), r.b.x()), std::max(r.a.y(), r.b.y())}
                  .Grown(0.05));
    }
  }

  /// Below a sloping roof: pieces, each as low as its lowest corner.
  void AddBlock(const Block& block) {
    Rect all{1e9, 1e9, -1e9, -1e9};
    for (const Vector3d& p : block.bottom) {
      all = {std::min(all.x0, p.x()), std::min(all.y0, p.y()), std::max(all.x1, p.x()),
             std::max(all.y1, p.y())};
    }
    const Vector3d &a = block.bottom[0], &b = block.bottom[1], &c = block.bottom[2];
    const Vector3d normal = (b - a).cross(c - a);
    const auto height_at = [&](double x, double y) {
      return a.z() - (normal.x() * (x - a.x()) + normal.y() * (y - a.y())) / normal.z();
    };
    constexpr int kPieces = 5;
    for (int i = 0; i < kPieces * kPieces; ++i) {
      const double w = all.Width() / kPieces, d = all.Depth() / kPieces;
      const double x = all.x0 + w * (i % kPieces), y = all.y0 + d * (i / kPieces);
      const double low = std::min(
          {height_at(x, y), height_at(x + w, y), height_at(x, y + d), height_at(x + w, y + d)});
      space.keep_out.push_back(Solid({x, y, x + w, y + d}, low, block.top_m));
    }
  }
};

}  // namespace

Box3 Solid(const Rect& r, double z0, double z1) {
  Box3 b;
  b.Add({r.x0, r.y0, z0});
  b.Add({r.x1, r.y1, z1});
  return b;
}

bool Overlap(const Box3& a, const Box3& b) {
  const Vector3d shared = a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min);
  const double thinnest = std::min((a.max - a.min).minCoeff(), (b.max - b.min).minCoeff());
  return shared.minCoeff() > std::min(kOverlapTolerance_m, 0.3 * thinnest);
}

RoomSpace SpaceOf(const HousePlan& plan, int room_index) {
  const Room& room = plan.rooms[static_cast<std::size_t>(room_index)];
  const Level& level = plan.levels[static_cast<std::size_t>(room.level)];
  RoomSpace space;
  space.floor_m = level.floor_m + room.offset_m;
  space.ceiling_m = level.ceiling_m;
  space.inner = room.rects[0].Grown(-kOffWall_m);
  SpaceMaker maker{plan, room.level, space};
  maker.AddOpenings();
  maker.AddStairs();
  for (const Block& block : plan.blocks) {
    if (block.room == room_index) maker.AddBlock(block);
  }
  return space;
}

}  // namespace crossnav::world
