// SPDX-License-Identifier: MIT
#include "crossnav/world/stairs.h"

namespace crossnav::world {
namespace {

Vector2d Turned(const Vector2d& p, int quarter_turns) {
  switch (((quarter_turns % 4) + 4) % 4) {
    case 1:
      return {-p.y(), p.x()};
    case 2:
      return {-p.x(), -p.y()};
    case 3:
      return {p.y(), -p.x()};
    default:
      return p;
  }
}

}  // namespace

Stair Moved(Stair stair, const Vector3d& p_world, int quarter_turns) {
  const auto move2 = [&](const Vector2d& p) -> Vector2d {
    return Turned(p, quarter_turns) + p_world.head<2>();
  };
  const auto move3 = [&](const Vector3d& p) {
    const Vector2d q = move2(p.head<2>());
    return Vector3d(q.x(), q.y(), p.z() + p_world.z());
  };
  const auto move_rect = [&](const Rect& r) {
    const Vector2d a = move2({r.x0, r.y0}), b = move2({r.x1, r.y1});
    return Rect{std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()),
                std::max(a.y(), b.y())};
  };
  for (auto& tread : stair.treads) {
    for (auto& p : tread.polygon) p = move2(p);
    tread.top_m += p_world.z();
  }
  for (auto& rail : stair.railings) {
    rail.a = move3(rail.a);
    rail.b = move3(rail.b);
  }
  stair.p_bottom = move3(stair.p_bottom);
  stair.p_top = move3(stair.p_top);
  for (auto& r : stair.footprint) r = move_rect(r);
  for (auto& r : stair.voids) r = move_rect(r);
  return stair;
}

Stair MakeStair(const StairParams& params) {
  return MakeStraightStair(params);
}

}  // namespace crossnav::world
