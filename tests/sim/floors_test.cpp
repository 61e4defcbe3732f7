// SPDX-License-Identifier: MIT
// Floors and connections, on shells whose storeys are known.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "crossnav/sim/navmesh/navmesh.h"
#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

TEST(Floors, AFlightOfStairsJoinsTwoFloors) {
  const Scene scene = TwoFloors();
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value());
  ASSERT_EQ(navmesh->Floors().size(), 2U);
  EXPECT_EQ(navmesh->Floors()[0].id, 0);
  EXPECT_NEAR(navmesh->Floors()[0].height_m, 0, 0.1);
  EXPECT_NEAR(navmesh->Floors()[1].height_m, 3, 0.1);
  ASSERT_EQ(navmesh->Connections().size(), 1U);
  EXPECT_EQ(navmesh->Connections()[0].lower, 0);
  EXPECT_EQ(navmesh->Connections()[0].upper, 1);
  EXPECT_NEAR(navmesh->Connections()[0].rise_m, 3, 0.15);
  EXPECT_EQ(navmesh->FloorOf({0, 0, 1.2}), 0);
  EXPECT_EQ(navmesh->FloorOf({0, 0, 1.8}), 1);
}

TEST(Floors, TheRampThroughTheStairsConnectsTheFloors) {
  const Scene scene = TwoFloors();
  const auto navmesh = NavMesh::Build(scene, {});
  const double run = kFlightEnd_x - kFlight_x;
  const auto d = navmesh->Geodesic({1, 0.5, 0}, {kFlightEnd_x + 1, 0.5, 3});
  ASSERT_TRUE(d.has_value());
  EXPECT_NEAR(*d, 1 + std::hypot(run, 3.0) + 1, 0.25);
  const auto back = navmesh->Geodesic({kFlightEnd_x + 1, 0.5, 3}, {1, 0.5, 0});
  EXPECT_NEAR(*back, *d, 1e-3);
}

TEST(Floors, RisersAboveTheClimbSeparateTheFloors) {
  const Scene scene = TwoFloors();
  NavMeshSettings settings;
  settings.max_climb_m = 0.15;
  const auto navmesh = NavMesh::Build(scene, settings);
  ASSERT_TRUE(navmesh.has_value());
  EXPECT_TRUE(navmesh->Connections().empty());
  EXPECT_FALSE(navmesh->Geodesic({1, 3, 0}, {8, 2, 3}).has_value());
}

TEST(Floors, AStepIntoASunkenRoomIsNoStorey) {
  MicroScene m;
  m.Begin("floor");
  m.Ground(0, 0, 5, 5, 0);
  m.Ground(5, 0, 10, 5, -0.25);
  m.Quad({5, 0, -0.25}, {5, 5, -0.25}, {5, 5, 0}, {5, 0, 0});
  const Scene scene = m.Finish();
  const auto navmesh = NavMesh::Build(scene, {});
  EXPECT_EQ(navmesh->Floors().size(), 1U);
  EXPECT_TRUE(navmesh->Geodesic({2, 2, 0}, {8, 2, -0.25}).has_value());
}

/// Ground at `heights`, side by side, with a step or a flight of three between neighbours.
Scene Levels(const std::vector<double>& heights) {
  MicroScene m;
  m.Begin("floor");
  double x = 0;
  for (std::size_t i = 0; i < heights.size(); ++i, x += 6) {
    m.Ground(x, 0, x + 5, 5, heights[i]);
    if (i + 1 == heights.size()) break;
    const double rise = (heights[i + 1] - heights[i]) / 5;
    for (int k = 0; k < 4; ++k) {
      m.Box({x + 5 + 0.25 * k, 0, heights[i] - 1},
            {x + 5 + 0.25 * (k + 1), 5, heights[i] + (k + 1) * rise});
    }
  }
  return m.Finish();
}

TEST(Floors, ASplitLevelOfAFewRisersIsNoStorey) {
  const Scene scene = Levels({0, 0.9});
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value());
  ASSERT_EQ(navmesh->Floors().size(), 1U);
  ASSERT_EQ(navmesh->Floors()[0].levels_m.size(), 2U);
  EXPECT_NEAR(navmesh->Floors()[0].levels_m[0], 0, 0.1);
  EXPECT_NEAR(navmesh->Floors()[0].levels_m[1], 0.9, 0.1);
  EXPECT_GT(navmesh->Floors()[0].area_m2, 40);  // of both
  EXPECT_TRUE(navmesh->Connections().empty());
  EXPECT_EQ(navmesh->FloorOf({8, 2, 0.9}), 0);
}

TEST(Floors, HalfStoreysAreMeasuredFromTheLowestLevel) {
  const Scene scene = Levels({0, 1.2, 2.4, 3.6});
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value());
  ASSERT_EQ(navmesh->Floors().size(), 2U);
  EXPECT_EQ(navmesh->FloorOf({8, 2, 1.2}), 0);
  EXPECT_EQ(navmesh->FloorOf({14, 2, 2.4}), 1);
  EXPECT_EQ(navmesh->FloorOf({20, 2, 3.6}), 1);
}

TEST(Floors, ALandingIsNoFloor) {
  // Two flights of eight stairs with a landing of 1 x 2 m at z = 1.4 between them (a U-turn).
  MicroScene m;
  m.Begin("floor");
  m.Ground(0, 0, 8, 5, 0);
  m.Begin("stairs");
  const double rise = 0.175, going = 0.27;
  const double end = 2 + 8 * going;
  for (int i = 0; i < 8; ++i) {
    m.Box({2 + i * going, 0, 0}, {2 + (i + 1) * going, 0.95, (i + 1) * rise});
    m.Box({end - (i + 1) * going, 1.05, 0}, {end - i * going, 2, 1.4 + (i + 1) * rise});
  }
  m.Box({end, 0, 0}, {end + 1, 2, 1.4});
  m.Begin("wall");
  m.Box({2, 0.95, 0}, {end, 1.05, 3.5});
  m.Begin("floor");
  m.Box({-4, 0, 2.65}, {2, 5, 2.8});
  const Scene scene = m.Finish();
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value());
  ASSERT_EQ(navmesh->Floors().size(), 2U);
  EXPECT_NEAR(navmesh->Floors()[1].height_m, 2.8, 0.1);
  ASSERT_EQ(navmesh->Connections().size(), 1U);
  const auto d = navmesh->Geodesic({1, 0.5, 0}, {1, 1.5, 2.8});
  ASSERT_TRUE(d.has_value());
  EXPECT_GT(*d, 2 * std::hypot(8 * going, 1.4));
}

TEST(Floors, AFlatRoofIsNotKept) {
  MicroScene m;
  m.Room(0, 0, 8, 8);
  m.Begin("roof");
  m.Box({-0.5, -0.5, 2.6}, {8.5, 8.5, 2.8});
  const Scene scene = m.Finish();
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_EQ(navmesh->Floors().size(), 1U);
  EXPECT_NEAR(navmesh->Floors()[0].height_m, 0, 0.1);
}

TEST(Floors, ATableTopIsNotKept) {
  MicroScene m;
  m.Room(0, 0, 8, 8);
  m.Begin("table");
  m.Box({3, 3, 0}, {5, 4.5, 0.75});
  const Scene scene = m.Finish();
  const auto navmesh = NavMesh::Build(scene, {});
  EXPECT_FALSE(navmesh->Snap({4, 3.75, 0.75}, 0.3, 0.3).has_value());
}

TEST(Floors, AnAtticIsNotKeptWhereGoalObjectsTellTheStoreys) {
  MicroScene m;
  m.Room(0, 0, 8, 8);
  m.Begin("bed", "bed");
  m.Box({1, 1, 0}, {3, 2.5, 0.5});
  m.Begin("roof");
  m.Box({-3, -3, 5}, {12, 12, 5.1});
  m.Begin("floor");
  m.Box({-3, -3, 2.6}, {12, 12, 2.8});  // a larger, covered, unreachable attic
  const Scene scene = m.Finish();
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_EQ(navmesh->Floors().size(), 1U);
  EXPECT_NEAR(navmesh->Floors()[0].height_m, 0, 0.1);
}

}  // namespace
}  // namespace crossnav::sim::test
