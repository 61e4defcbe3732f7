// SPDX-License-Identifier: MIT
// Every kind of stair in a small shaft on a corridor, walked up and down with the simulator's
// actions on the simulator's own navmesh.
#include "crossnav/world/stairs/stairs.h"

#include <gtest/gtest.h>

#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/plan/plan_walls.h"
#include "crossnav/world/scene/scene_writer.h"
#include "crossnav/world/shell/architecture.h"
#include "oracle_walk.h"
#include "support/temp_folder.h"

namespace crossnav::world {
namespace {

struct StairShaft {
  HousePlan plan;
  Vector3d p_below, p_above;  ///< on the corridors
};

/// A corridor 2 m wide south of the shaft on `storeys` + 1 levels.
StairShaft MakeShaft(StairParams params, int storeys = 1) {
  StairShaft shaft;
  HousePlan& plan = shaft.plan;
  plan.id = "00001-Shaft";
  StairBlock block = MakeStairBlock(params);
  for (int level = 0; level <= storeys; ++level) {
    plan.levels.push_back({level * params.rise_m, (level + 1) * params.rise_m - params.slab_m});
    Room hall;
    hall.type = RoomType::kHall;
    hall.level = level;
    hall.rects = {{0, -2, block.width_m, 0}, {0, 0, block.width_m, block.depth_m}};
    plan.rooms.push_back(hall);
    if (level == storeys) continue;
    if (level > 0) params.body = StairBody::kClosed;
    params.is_continued = level + 1 < storeys;
    Stair stair = Moved(MakeStairBlock(params).stair, {0, 0, level * params.rise_m}, 0);
    stair.lower_level = level;
    stair.upper_level = level + 1;
    stair.room = level;
    plan.stairs.push_back(std::move(stair));
  }
  DeriveWalls(plan, {});
  RailVoids(plan, params.rail_style);
  shaft.p_below = {0.5 * block.width_m, -1.2, 0};
  shaft.p_above = {0.5 * block.width_m, -1.2, storeys * params.rise_m};
  return shaft;
}

/// Walks from below to above and back.
void ExpectWalkable(const StairShaft& shaft) {
  const test::TempFolder dir;
  const auto folder = WriteScene(BuildHouse(shaft.plan), dir.path());
  ASSERT_TRUE(folder.has_value());
  const auto scene = sim::LoadScene(*folder);
  ASSERT_TRUE(scene.has_value()) << scene.error().Message();
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  ASSERT_TRUE(navmesh.has_value()) << navmesh.error().Message();
  const auto below = navmesh->Snap(shaft.p_below), above = navmesh->Snap(shaft.p_above);
  ASSERT_TRUE(below && above);
  EXPECT_GT(above->z() - below->z(), 0.9 * (shaft.p_above.z() - shaft.p_below.z()));
  ASSERT_TRUE(navmesh->Geodesic(*below, *above).has_value()) << "no way up";
  const sim::RayCaster caster(*scene);
  sim::Simulator simulator(*scene, *navmesh, caster, {}, {});
  ASSERT_TRUE(simulator.Reset({*below, 0.4, 0}).has_value());
  const WalkResult up = WalkTo(simulator, *above);
  EXPECT_TRUE(up.arrived) << up.remaining_m << " m left going up";
  const WalkResult down = WalkTo(simulator, *below);
  EXPECT_TRUE(down.arrived) << down.remaining_m << " m left going down";
}

struct Case {
  StairKind kind;
  StairBody body;
};

class EveryStair : public testing::TestWithParam<Case> {};

TEST_P(EveryStair, IsWalkedUpAndDown) {
  StairParams params;
  params.kind = GetParam().kind;
  params.body = GetParam().body;
  ExpectWalkable(MakeShaft(params));
}

TEST_P(EveryStair, IsWalkedWhereItIsSteepestAndNarrowest) {
  StairParams params;
  params.kind = GetParam().kind;
  params.body = GetParam().body;
  params.rise_m = 2.52;
  params.risers = 12;  // 21 cm
  params.tread_m = 0.24;
  params.width_m = params.kind == StairKind::kSpiral ? 0.9 : 0.8;
  params.slab_m = 0.22;
  ExpectWalkable(MakeShaft(params));
}

// The second edition of the generator builds them (layout/stair_draw.h).
TEST_P(EveryStair, IsWalkedWithTheTreadsOfAnAttic) {
  StairParams params;
  params.kind = GetParam().kind;
  params.body = GetParam().body;
  params.rise_m = 2.61;
  params.risers = 9;  // 29 cm, just below the climb limit
  params.tread_m = 0.15;
  params.width_m = params.kind == StairKind::kSpiral ? 0.9 : 0.65;
  params.slab_m = 0.22;
  ExpectWalkable(MakeShaft(params));
}

TEST_P(EveryStair, StacksOverThreeFloors) {
  StairParams params;
  params.kind = GetParam().kind;
  params.body = GetParam().body;
  ExpectWalkable(MakeShaft(params, 2));
}

std::string NameOfCase(const testing::TestParamInfo<Case>& info) {
  std::string name(NameOf(info.param.kind));
  std::replace(name.begin(), name.end(), ' ', '_');
  const char* bodies[] = {"_solid", "_closed", "_open"};
  return name + bodies[static_cast<int>(info.param.body)];
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryStair,
                         testing::Values(Case{StairKind::kStraight, StairBody::kSolid},
                                         Case{StairKind::kStraight, StairBody::kOpenRisers},
                                         Case{StairKind::kStraightLanding, StairBody::kClosed},
                                         Case{StairKind::kL, StairBody::kSolid},
                                         Case{StairKind::kL, StairBody::kClosed},
                                         Case{StairKind::kU, StairBody::kClosed},
                                         Case{StairKind::kU, StairBody::kOpenRisers},
                                         Case{StairKind::kWinder, StairBody::kSolid},
                                         Case{StairKind::kSpiral, StairBody::kOpenRisers},
                                         Case{StairKind::kDouble, StairBody::kClosed},
                                         Case{StairKind::kHalfWinder, StairBody::kSolid},
                                         Case{StairKind::kHalfWinder, StairBody::kOpenRisers},
                                         Case{StairKind::kAttic, StairBody::kOpenRisers}),
                         NameOfCase);

TEST(Stairs, RisersAndTreadsHaveTheRequestedSizes) {
  for (StairKind kind :
       {StairKind::kStraight, StairKind::kStraightLanding, StairKind::kU, StairKind::kL,
        StairKind::kWinder, StairKind::kHalfWinder, StairKind::kAttic}) {
    StairParams params;
    params.kind = kind;
    const Stair stair = MakeStairBlock(params).stair;
    ASSERT_EQ(stair.treads.size(), 15U) << NameOf(kind);
    double z = 0;
    for (const Tread& tread : stair.treads) {
      EXPECT_NEAR(tread.top_m - z, 0.175, 1e-9) << NameOf(kind);
      z = tread.top_m;
    }
  }
}

TEST(Stairs, ALandingIsAsLongAsWasAskedFor) {
  for (StairKind kind : {StairKind::kStraightLanding, StairKind::kU}) {
    StairParams params;
    params.kind = kind;
    const StairBlock usual = MakeStairBlock(params);
    params.landing_m = 2.0;
    const StairBlock deep = MakeStairBlock(params);
    const double by_m = deep.width_m + deep.depth_m - usual.width_m - usual.depth_m;
    EXPECT_GT(by_m, 0.9) << NameOf(kind);
    ExpectWalkable(MakeShaft(params));
  }
}

TEST(Stairs, NoStepWithoutRisersIsTooHighForAChild) {
  const Stair steps = MakeSteps(0.8, 5, 0.3, 1.4);
  EXPECT_EQ(steps.treads.size(), 4U);
  EXPECT_TRUE(steps.voids.empty());
  EXPECT_NEAR(steps.riser_m, 0.16, 1e-9);
}

TEST(RailVoids, ClosesEveryEdgeWithoutWallOrStair) {
  StairParams params;
  StairShaft shaft = MakeShaft(params);
  double length = 0;
  for (const Railing& r : shaft.plan.railings) length += (r.b - r.a).norm();
  // The long side towards the corridor and the short one over the first treads.
  const Rect hole = shaft.plan.stairs[0].voids[0];
  EXPECT_NEAR(length, hole.Width() + hole.Depth(), 0.1);
}

}  // namespace
}  // namespace crossnav::world
