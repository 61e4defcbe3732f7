// SPDX-License-Identifier: MIT
#include "crossnav/world/stairs/stairs.h"

#include <algorithm>

namespace crossnav::world {
namespace {

constexpr double kHeadroom_m = 2.0;  // chosen: the building codes' usual clear height over stairs

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

/// Applies `move2` in the plan and lifts by `z_m`.
template <class F>
void Transform(Stair& stair, double z_m, F move2) {
  const auto move3 = [&](const Vector3d& p) {
    const Vector2d q = move2(Vector2d(p.head<2>()));
    return Vector3d(q.x(), q.y(), p.z() + z_m);
  };
  const auto move_rect = [&](const Rect& r) {
    const Vector2d a = move2(Vector2d(r.x0, r.y0)), b = move2(Vector2d(r.x1, r.y1));
    return Rect{std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()),
                std::max(a.y(), b.y())};
  };
  stair.ground_m += z_m;
  for (auto& tread : stair.treads) {
    for (auto& p : tread.polygon) p = move2(p);
    tread.top_m += z_m;
  }
  if (stair.column) {
    for (auto& p : stair.column->polygon) p = move2(p);
    stair.column->top_m += z_m;
  }
  for (auto& rail : stair.railings) {
    rail.a = move3(rail.a);
    rail.b = move3(rail.b);
  }
  for (auto* edges : {&stair.arrivals, &stair.departures}) {
    for (auto& e : *edges) e = {move2(e.a), move2(e.b)};
  }
  stair.p_bottom = move3(stair.p_bottom);
  stair.p_top = move3(stair.p_top);
  for (auto& r : stair.footprint) r = move_rect(r);
  for (auto& r : stair.voids) r = move_rect(r);
}

}  // namespace

Stair Moved(Stair stair, const Vector3d& p_world, int quarter_turns) {
  Transform(stair, p_world.z(), [&](const Vector2d& p) -> Vector2d {
    return Turned(p, quarter_turns) + p_world.head<2>();
  });
  return stair;
}

Stair Mirrored(Stair stair) {
  Transform(stair, 0, [](const Vector2d& p) -> Vector2d { return {-p.x(), p.y()}; });
  for (auto& tread : stair.treads) std::reverse(tread.polygon.begin(), tread.polygon.end());
  return stair;
}

int TreadsUnderCeiling(const StairParams& params) {
  const double riser_m = params.rise_m / params.risers;
  const double ceiling_m = params.rise_m - params.slab_m;
  int n = 0;
  while (n < params.risers - 1 && ceiling_m - (n + 1) * riser_m >= kHeadroom_m) ++n;
  return n;
}

std::string_view NameOf(StairKind kind) {
  switch (kind) {
    case StairKind::kStraight:
      return "straight";
    case StairKind::kStraightLanding:
      return "straight with landing";
    case StairKind::kL:
      return "L";
    case StairKind::kU:
      return "U with half landing";
    case StairKind::kWinder:
      return "winder";
    case StairKind::kSpiral:
      return "spiral";
    case StairKind::kSplitLevel:
      return "split level";
    case StairKind::kDouble:
      return "two flights side by side";
    case StairKind::kBasement:
      return "basement";
    case StairKind::kHalfWinder:
      return "half turn of winders";
    case StairKind::kAttic:
      return "attic";
  }
  return "?";
}

}  // namespace crossnav::world
