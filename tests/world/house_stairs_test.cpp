// SPDX-License-Identifier: MIT
// The stairs that only houses have, walked up and down with the simulator's actions: the flight to
// a basement behind its door, and the few steps between floors of one storey.
#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/house/house_generator.h"
#include "crossnav/world/layout/house_plan.h"
#include "crossnav/world/shell/architecture.h"
#include "oracle_walk.h"
#include "support/temp_folder.h"

namespace crossnav::world {
namespace {

/// First plan from `seed` on with a stair that `is_wanted` accepts; the stair's index with it.
template <class F>
std::pair<HousePlan, std::size_t> DrawPlanWith(HouseParams params, F is_wanted) {
  for (; params.seed < 4000; ++params.seed) {
    Rng rng(params.seed, 1);
    auto plan = DrawHousePlan(params, rng);
    if (!plan) continue;
    for (std::size_t i = 0; i < plan->stairs.size(); ++i) {
      if (!is_wanted(plan->stairs[i])) continue;
      plan->id = "00001-Stairs";
      return {std::move(*plan), i};
    }
  }
  return {};
}

/// Ground of the room of `type` on `level`, at the middle of its first rectangle.
Vector3d MiddleOf(const HousePlan& plan, RoomType type, int level) {
  for (const Room& room : plan.rooms) {
    if (room.type != type || room.level != level) continue;
    const Vector2d c = room.rects[0].Center();
    return {c.x(), c.y(), plan.levels[static_cast<std::size_t>(level)].floor_m + room.offset_m};
  }
  return Vector3d::Constant(1e9);
}

/// From `low` up to `high` and back, on the navmesh of the house without furniture.
void ExpectWalkedBothWays(const HousePlan& plan, const Vector3d& low, const Vector3d& high) {
  const sim::Scene scene = BuildHouse(plan);
  const auto navmesh = sim::NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value()) << navmesh.error().Message();
  const auto below = navmesh->Snap(low, 0.8, 0.2), above = navmesh->Snap(high, 0.8, 0.2);
  ASSERT_TRUE(below && above);
  ASSERT_TRUE(navmesh->Geodesic(*below, *above).has_value()) << "no way up";
  const sim::RayCaster caster(scene);
  sim::Simulator simulator(scene, *navmesh, caster, {}, {});
  ASSERT_TRUE(simulator.Reset({*below, 0.4, 0}).has_value());
  const WalkResult up = WalkTo(simulator, *above, 1500);
  EXPECT_TRUE(up.arrived) << up.remaining_m << " m left going up";
  EXPECT_NEAR(simulator.agent().p_world.z(), high.z(), 0.15);
  const WalkResult down = WalkTo(simulator, *below, 1500);
  EXPECT_TRUE(down.arrived) << down.remaining_m << " m left going down";
  EXPECT_NEAR(simulator.agent().p_world.z(), low.z(), 0.15);
}

/// Openings with a door leaf in the walls around the stairwell of `level`.
int DoorsOfStairwell(const HousePlan& plan, int level) {
  const auto is_stairwell = [&](int room) {
    return room >= 0 && plan.rooms[static_cast<std::size_t>(room)].type == RoomType::kStairwell;
  };
  int doors = 0;
  for (const Wall& wall : plan.walls) {
    if (wall.level != level || (!is_stairwell(wall.room) && !is_stairwell(wall.other_room))) {
      continue;
    }
    for (const Opening& o : wall.openings) doors += o.kind == OpeningKind::kDoorOpen ? 1 : 0;
  }
  return doors;
}

TEST(BasementStair, IsWalkedUpAndDownThroughItsDoor) {
  HouseParams params;
  params.floors = 2;
  params.area_m2 = 80;
  for (params.seed = 1; params.seed < 60; params.seed += 20) {
    const auto [plan, i] =
        DrawPlanWith(params, [](const Stair& s) { return s.kind == StairKind::kBasement; });
    ASSERT_LT(i, plan.stairs.size());
    EXPECT_EQ(DoorsOfStairwell(plan, 1), 1);
    ExpectWalkedBothWays(plan, MiddleOf(plan, RoomType::kHall, 0),
                         MiddleOf(plan, RoomType::kHall, 1));
  }
}

class SplitLevel : public testing::TestWithParam<int> {};

TEST_P(SplitLevel, IsWalkedUpAndDown) {
  HouseParams params;
  params.floors = 1;
  params.area_m2 = 100;
  const auto [plan, i] = DrawPlanWith(params, [](const Stair& s) {
    return s.kind == StairKind::kSplitLevel && static_cast<int>(s.treads.size()) + 1 == GetParam();
  });
  ASSERT_LT(i, plan.stairs.size());
  const Stair& stair = plan.stairs[i];
  const Vector3d hall = MiddleOf(plan, RoomType::kHall, 0);
  const double sunk_m = plan.rooms[static_cast<std::size_t>(stair.room)].offset_m;
  EXPECT_NEAR(sunk_m, -GetParam() * stair.riser_m, 1e-9);
  EXPECT_LT(sunk_m, -0.4);
  ExpectWalkedBothWays(plan, {stair.p_bottom.x(), stair.p_bottom.y(), sunk_m}, hall);
}

INSTANTIATE_TEST_SUITE_P(Risers, SplitLevel, testing::Range(3, 8));

// A sliver of the navmesh's detail reaches up to the flight above in this house: one forward step
// of the robot led there.
TEST(HouseStairs, AStepOverASliverDoesNotEndOnTheFlightAbove) {
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 18;
  params.floors = 4;
  const auto report = GenerateHouse(params, dir.path());
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene.has_value());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  ASSERT_TRUE(navmesh.has_value());
  const Vector3d p(-5.49, 4.02, 2.61), ahead(std::cos(-2.478), std::sin(-2.478), 0);
  ASSERT_TRUE(navmesh->Snap(p, 0.05, 0.2).has_value());
  for (const double walked_m : {0.20, 0.25, 0.30}) {
    const Vector3d q = navmesh->WalkStraight(p, p + walked_m * ahead);
    EXPECT_NEAR((q - p).head<2>().norm(), walked_m, 0.02);
    EXPECT_NEAR(q.z(), p.z(), 0.3) << q.transpose();
  }
}

}  // namespace
}  // namespace crossnav::world
