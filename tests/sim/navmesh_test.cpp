// SPDX-License-Identifier: MIT
#include "crossnav/sim/navmesh/navmesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

// Walls keep the agent's centre off by its radius in whole cells (0.10 m -> 4 x 0.03 m), and a cell
// more or less where walls do not lie on the grid.
constexpr double kInset_m = 0.12, kCell_m = 0.03;

Scene EmptyRoom() {
  MicroScene m;
  m.Room(0, 0, 12, 9);
  return m.Finish();
}

/// A room of 10 x 8 m with a block of 2 x 4 m in the middle that reaches the south wall.
Scene RoomWithBlock() {
  MicroScene m;
  m.Room(0, 0, 10, 8);
  m.Begin("block");
  m.Box({4, 0, 0}, {6, 4, 2.6});
  return m.Finish();
}

NavMesh Build(const Scene& scene, const NavMeshSettings& settings = {}) {
  auto navmesh = NavMesh::Build(scene, settings);
  if (!navmesh) throw std::runtime_error(navmesh.error().Message());
  return std::move(*navmesh);
}

TEST(NavMesh, DistancesInAnEmptyRoomAreStraight) {
  const Scene scene = EmptyRoom();
  const NavMesh navmesh = Build(scene);
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Vector3d a(rng.Uniform(0.3, 11.7), rng.Uniform(0.3, 8.7), 0);
    const Vector3d b(rng.Uniform(0.3, 11.7), rng.Uniform(0.3, 8.7), 0);
    const auto d = navmesh.Geodesic(a, b);
    ASSERT_TRUE(d.has_value());
    EXPECT_NEAR(*d, (a - b).norm(), 1e-3);
  }
}

TEST(NavMesh, AreaIsTheRoomLessTheInset) {
  const Scene scene = EmptyRoom();
  const double expected = (12 - 2 * kInset_m) * (9 - 2 * kInset_m);
  EXPECT_NEAR(Build(scene).AreaM2(), expected, 2 * kCell_m * (12 + 9) * 2);
}

TEST(NavMesh, TheShortestPathBendsAroundTheBlock) {
  const Scene scene = RoomWithBlock();
  const NavMesh navmesh = Build(scene);
  const Vector3d a(1, 1, 0), b(9, 1, 0);
  const double y = 4 + kInset_m, x0 = 4 - kInset_m, x1 = 6 + kInset_m;
  const double expected = std::hypot(x0 - 1, y - 1) + (x1 - x0) + std::hypot(9 - x1, y - 1);
  const auto d = navmesh.Geodesic(a, b);
  ASSERT_TRUE(d.has_value());
  EXPECT_NEAR(*d, expected, 3 * kCell_m);
  const auto path = navmesh.ShortestPath(a, b);
  ASSERT_GE(path.size(), 4U);
  EXPECT_LT((path.front() - a).head<2>().norm(), 1e-3);
  EXPECT_LT((path.back() - b).head<2>().norm(), 1e-3);
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  EXPECT_NEAR(length, *d, 1e-3);
}

TEST(NavMesh, ManyGoalsGiveTheNearestOfThemAll) {
  const Scene scene = RoomWithBlock();
  const NavMesh navmesh = Build(scene);
  Rng rng(9);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vector3d> goals;
    for (int i = 0; i < 12; ++i) goals.push_back(*navmesh.RandomPoint(rng));
    const Vector3d from = *navmesh.RandomPoint(rng);
    double best = 1e9;
    for (const Vector3d& goal : goals) best = std::min(best, *navmesh.Geodesic(from, goal));
    std::size_t nearest = 99;
    const auto d = navmesh.Geodesic(from, goals, &nearest);
    ASSERT_TRUE(d.has_value());
    EXPECT_NEAR(*d, best, 1e-6);
    ASSERT_LT(nearest, goals.size());
    EXPECT_NEAR(*navmesh.Geodesic(from, goals[nearest]), best, 1e-6);
  }
}

TEST(NavMesh, ThereIsNoPathToAnUnreachablePlace) {
  MicroScene m;
  m.Room(0, 0, 5, 5);
  m.Room(6, 0, 11, 5);
  const Scene scene = m.Finish();
  const NavMesh navmesh = Build(scene);
  const Vector3d left(2, 2, 0), right(8, 2, 0);
  ASSERT_TRUE(navmesh.Snap(left).has_value());
  ASSERT_TRUE(navmesh.Snap(right).has_value());
  EXPECT_FALSE(navmesh.Geodesic(left, right).has_value());
  EXPECT_TRUE(navmesh.ShortestPath(left, right).empty());
  const std::vector<Vector3d> goals{right, {2, 4, 0}};
  std::size_t nearest = 9;
  EXPECT_NEAR(navmesh.Geodesic(left, goals, &nearest).value_or(-1), 2, 1e-3);
  EXPECT_EQ(nearest, 1U);
}

TEST(NavMesh, SnapStaysWithinItsLimits) {
  const Scene scene = EmptyRoom();
  const NavMesh navmesh = Build(scene);
  EXPECT_FALSE(navmesh.Snap({-2, 4, 0}).has_value());
  EXPECT_FALSE(navmesh.Snap({4, 4, 1.5}).has_value());
  EXPECT_FALSE(navmesh.Snap({NAN, 4, 0}).has_value());
  const auto p = navmesh.Snap({-0.2, 4, 0});
  ASSERT_TRUE(p.has_value());
  EXPECT_NEAR(p->x(), kInset_m, kCell_m + 1e-3);
  EXPECT_NEAR(p->z(), 0, 0.06);
}

TEST(NavMesh, WalkingEndsAtTheWallWithoutSliding) {
  const Scene scene = EmptyRoom();
  const NavMesh navmesh = Build(scene);
  // Obliquely towards the wall x = 12: a sliding agent would end at the y of the wished end.
  const Vector3d start(11, 4, 0), end(13, 6, 0);
  const Vector3d reached = navmesh.WalkStraight(start, end);
  EXPECT_NEAR(reached.x(), 12 - kInset_m, 2 * kCell_m);
  EXPECT_NEAR(reached.y() - 4, reached.x() - 11, 2e-3);  // still on the straight line
  // Pressed against the wall, it stays where it is, and can leave in other directions.
  const Vector3d again = navmesh.WalkStraight(reached, reached + Vector3d(0.25, 0.25, 0));
  EXPECT_LT((again - reached).norm(), 0.02);
  const Vector3d along = navmesh.WalkStraight(reached, reached + Vector3d(0, 0.25, 0));
  EXPECT_NEAR((along - reached).norm(), 0.25, 1e-3);
  const Vector3d back = navmesh.WalkStraight(reached, reached - Vector3d(0.25, 0, 0));
  EXPECT_NEAR((back - reached).norm(), 0.25, 1e-3);
}

TEST(NavMesh, NeverWalksThroughAWallFromAnywhereInAnyDirection) {
  const Scene scene = RoomWithBlock();
  const NavMesh navmesh = Build(scene);
  Rng rng(21);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d start = *navmesh.RandomPoint(rng);
    const double heading = rng.Uniform(-3.2, 3.2), length = rng.Uniform(0.1, 4);
    const Vector3d d(std::cos(heading), std::sin(heading), 0);
    const Vector3d end = navmesh.WalkStraight(start, start + length * d);
    const Vector3d moved = end - start;
    // No sliding; a start on the very border may step a centimetre off it first.
    EXPECT_NEAR(moved.x() * d.y() - moved.y() * d.x(), 0, 0.011);
    const bool in_room = end.x() > 0.05 && end.x() < 9.95 && end.y() > 0.05 && end.y() < 7.95;
    const bool in_block = end.x() > 3.95 && end.x() < 6.05 && end.y() < 4.05;
    ASSERT_TRUE(in_room && !in_block) << start.transpose() << " -> " << end.transpose();
    // The midpoint was not in the block either.
    const Vector3d middle = 0.5 * (start + end);
    ASSERT_FALSE(middle.x() > 3.95 && middle.x() < 6.05 && middle.y() < 4.05);
  }
}

TEST(NavMesh, LowSillsAreSteppedOverAndHighSillsAreNot) {
  for (const double sill_m : {0.25, 0.40}) {
    MicroScene m;
    m.Room(0, 0, 6, 4);
    m.Begin("sill");
    m.Box({2.9, 0, 0}, {3.1, 4, sill_m});
    const Scene scene = m.Finish();
    const NavMesh navmesh = Build(scene);
    EXPECT_EQ(navmesh.Geodesic({1, 2, 0}, {5, 2, 0}).has_value(), sill_m < 0.3) << sill_m;
  }
}

TEST(NavMesh, TheAgentNeedsItsHeadRoom) {
  for (const double lintel_m : {1.6, 1.4}) {
    MicroScene m;
    m.Room(0, 0, 6, 4);
    m.Begin("beam");
    m.Box({2.5, 0, lintel_m}, {3.5, 4, 2.6});
    const Scene scene = m.Finish();
    EXPECT_EQ(Build(scene).Geodesic({1, 2, 0}, {5, 2, 0}).has_value(), lintel_m > 1.5) << lintel_m;
  }
}

TEST(NavMesh, WindingOfTheTrianglesDoesNotMatter) {
  MicroScene m;
  m.Room(0, 0, 5, 5);
  Scene scene = m.Finish();
  for (auto& t : scene.mesh.triangles) std::swap(t[1], t[2]);
  UpdateDerived(scene);
  EXPECT_NEAR(Build(scene).AreaM2(), 4.76 * 4.76, 1);
}

TEST(NavMesh, TheSameInputGivesTheSameMesh) {
  const Scene scene = RoomWithBlock();
  EXPECT_EQ(Build(scene).Hash(), Build(scene).Hash());
  NavMeshSettings wide;
  wide.agent_radius_m = 0.2;
  EXPECT_NE(Build(scene).Hash(), Build(scene, wide).Hash());
}

TEST(NavMesh, RandomPointsLieOnTheMeshAndAreSpreadOverIt) {
  const Scene scene = RoomWithBlock();
  const NavMesh navmesh = Build(scene);
  Rng rng(4);
  int left = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto p = navmesh.RandomPoint(rng);
    ASSERT_TRUE(p.has_value());
    left += p->x() < 5 ? 1 : 0;
  }
  EXPECT_NEAR(left, 500, 60);
}

TEST(NavMesh, HeightsAtListsEveryStoreyInAColumn) {
  const Scene scene = TwoFloors();
  const NavMesh navmesh = Build(scene);
  const auto heights = navmesh.HeightsAt(8, 2, -1, 5);
  ASSERT_EQ(heights.size(), 2U);
  EXPECT_NEAR(heights[0], 0, 0.1);
  EXPECT_NEAR(heights[1], 3, 0.1);
  EXPECT_EQ(navmesh.HeightsAt(8, 2, 1, 5).size(), 1U);
  EXPECT_TRUE(navmesh.HeightsAt(20, 2, -1, 5).empty());
}

TEST(NavMesh, ASceneWithoutGroundIsAnError) {
  MicroScene m;
  m.Begin("wall");
  m.Quad({0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {0, 0, 2});
  const Scene scene = m.Finish();
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_FALSE(navmesh.has_value());
  EXPECT_EQ(navmesh.error().code, ErrorCode::kInvalid);
}

TEST(NavMesh, ASceneTooLargeForItsCellsSaysSo) {
  MicroScene m;
  m.Begin("floor");
  m.Ground(0, 0, 2000, 2000);
  const Scene scene = m.Finish();
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_FALSE(navmesh.has_value());
  EXPECT_NE(navmesh.error().what.find("cell_m"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::sim::test
