// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/plan_turn.h"

#include <algorithm>

#include "crossnav/core/check.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::world {

void TurnPlan(HousePlan& plan, int quarter_turns) {
  CROSSNAV_CHECK(plan.furniture.empty(), "a plan is turned before it is furnished");
  for (int turn = 0; turn < quarter_turns; ++turn) {
    const auto rect = [](const Rect& r) { return Rect{-r.y1, r.x0, -r.y0, r.x1}; };
    const auto point = [](const Vector2d& p) -> Vector2d { return {-p.y(), p.x()}; };
    for (Room& room : plan.rooms) {
      for (Rect& r : room.rects) r = rect(r);
    }
    for (Wall& wall : plan.walls) {
      wall.a = point(wall.a);
      wall.b = point(wall.b);
    }
    for (auto& [level, r] : plan.voids) r = rect(r);
    for (Railing& r : plan.railings) {
      r.a.head<2>() = point(r.a.head<2>());
      r.b.head<2>() = point(r.b.head<2>());
    }
    for (Block& block : plan.blocks) {
      for (Vector3d& p : block.bottom) p.head<2>() = point(p.head<2>());
    }
    for (Stair& stair : plan.stairs) stair = Moved(std::move(stair), Vector3d::Zero(), 1);
  }
}

}  // namespace crossnav::world
