// SPDX-License-Identifier: MIT
#include "crossnav/world/surface/bake_light.h"

#include <gtest/gtest.h>

#include "crossnav/world/mesh/subdivide.h"
#include "crossnav/world/plan/plan_walls.h"
#include "crossnav/world/shell/architecture.h"

namespace crossnav::world {
namespace {

/// Two rooms side by side, 5 x 4 m and 3 x 4 m, without a door between them. The first has a window
/// in the middle of its wall on x = 0.
HousePlan TwoRooms() {
  HousePlan plan;
  plan.id = "00001-Light";
  plan.levels = {{0, 2.5}};
  Room room;
  room.rects = {{0, 0, 5, 4}};
  plan.rooms.push_back(room);
  room.rects = {{5, 0, 8, 4}};
  plan.rooms.push_back(room);
  DeriveWalls(plan, {});
  for (Wall& wall : plan.walls) {
    if (std::abs(wall.a.x()) > 1e-6 || std::abs(wall.b.x()) > 1e-6) continue;
    EXPECT_TRUE(AddOpening(wall, {OpeningKind::kWindow, 2, 1.4, 0.9, 2.1, true, true}));
  }
  return plan;
}

void Put(HousePlan& plan, const char* name, const Vector3d& size, const Vector3d& p, int room) {
  ModelBuilder b(name);
  b.Colour({90, 90, 90});
  b.mesh.AddBox({-size.x() / 2, -size.y() / 2, 0}, {size.x() / 2, size.y() / 2, size.z()});
  plan.furniture.push_back({b.Finish(), StandAt(p, 0), room});
}

sim::Scene Lit(const HousePlan& plan) {
  BuiltHouse house = BuildHouseWithLights(plan, {true, 1});
  Subdivide(house.scene.mesh, 0.3, 0.01);
  BakeLight(house.scene, plan, LightsOf(plan), house.glowing);
  return std::move(house.scene);
}

/// Mean tone of the ground in the rectangle.
double GroundTone(const sim::Scene& scene, const Rect& rect) {
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < scene.mesh.vertices.size(); ++v) {
    const Vector3f& p = scene.mesh.vertices[v];
    if (std::abs(p.z()) > 1e-4F || !rect.Contains({p.x(), p.y()})) continue;
    sum += scene.mesh.vertex_colours[v].g;
    ++count;
  }
  EXPECT_GT(count, 0);
  return sum / std::max(count, 1);
}

TEST(LightsOf, FindsWindowsWithTheInsideAndLampsWhereTheyAre) {
  HousePlan plan = TwoRooms();
  Put(plan, "ceiling lamp", {0.3, 0.3, 0.2}, {6.5, 2, 2.3}, 1);
  const HouseLights lights = LightsOf(plan);
  ASSERT_EQ(lights.lights.size(), 2U);
  EXPECT_TRUE(lights.lights[0].IsWindow());
  EXPECT_EQ(lights.lights[0].room, 0);
  EXPECT_NEAR(lights.lights[0].inward.x(), 1, 1e-9);
  EXPECT_FALSE(lights.lights[1].IsWindow());
  EXPECT_LT(lights.lights[1].p_world.z(), 2.3);
  EXPECT_EQ(lights.bounced.size(), 2U);
}

TEST(BakeLight, ItIsBrighterNearTheWindow) {
  const sim::Scene scene = Lit(TwoRooms());
  EXPECT_GT(GroundTone(scene, {0.8, 1.5, 1.6, 2.5}), GroundTone(scene, {3.5, 1.5, 4.5, 2.5}) + 15);
}

TEST(BakeLight, WallsKeepTheLightInTheRoom) {
  const sim::Scene scene = Lit(TwoRooms());
  EXPECT_LT(GroundTone(scene, {5.4, 1, 7.6, 3}), GroundTone(scene, {3.5, 1.5, 4.5, 2.5}));
}

TEST(BakeLight, ALampLightsItsRoomAndNotTheNext) {
  HousePlan plan = TwoRooms();
  const sim::Scene dark = Lit(plan);
  Put(plan, "ceiling lamp", {0.3, 0.3, 0.2}, {6.5, 2, 2.3}, 1);
  const sim::Scene scene = Lit(plan);
  const Rect there{5.4, 1, 7.6, 3}, here{2, 1, 4.5, 3};
  EXPECT_GT(GroundTone(scene, there), GroundTone(dark, there) + 30);
  EXPECT_NEAR(GroundTone(scene, here), GroundTone(dark, here), 2);
}

TEST(BakeLight, ATableTopThrowsAShadow) {
  HousePlan plan = TwoRooms();
  Put(plan, "ceiling lamp", {0.3, 0.3, 0.2}, {6.5, 2, 2.3}, 1);
  const sim::Scene bare = Lit(plan);
  Put(plan, "table", {1.2, 1.2, 0.03}, {6.5, 2, 0.7}, 1);
  const sim::Scene scene = Lit(plan);
  const Rect under{6.2, 1.7, 6.8, 2.3};
  EXPECT_LT(GroundTone(scene, under), GroundTone(bare, under) - 30);
}

TEST(BakeLight, CornersAreDarkerThanOpenGroundAndNothingIsBlack) {
  HousePlan plan = TwoRooms();
  plan.walls.front().openings.clear();
  const sim::Scene scene = Lit(plan);
  const double middle = GroundTone(scene, {6, 1.5, 7, 2.5});
  EXPECT_LT(GroundTone(scene, {5.06, 3.8, 5.3, 3.94}), middle - 8);
  for (std::size_t v = 0; v < scene.mesh.vertices.size(); ++v) {
    EXPECT_GE(scene.mesh.vertex_colours[v].g, 60);
  }
}

TEST(BakeLight, ScreensAndPanesStayAsBrightAsTheyAre) {
  const HousePlan plan = TwoRooms();
  BuiltHouse house = BuildHouseWithLights(plan, {true, 1});
  ASSERT_EQ(house.glowing.size(), 1U);
  BakeLight(house.scene, plan, LightsOf(plan), house.glowing);
  int panes = 0;
  for (std::size_t t = 0; t < house.scene.mesh.triangles.size(); ++t) {
    if (house.glowing.count(house.scene.mesh.triangle_material[t]) == 0) continue;
    ++panes;
    for (auto v : house.scene.mesh.triangles[t]) {
      EXPECT_EQ(house.scene.mesh.vertex_colours[v], (Rgb8{255, 255, 255}));
    }
  }
  EXPECT_GT(panes, 0);
}

TEST(BakeLight, GivesTheSameTwice) {
  EXPECT_EQ(Lit(TwoRooms()).mesh.vertex_colours, Lit(TwoRooms()).mesh.vertex_colours);
}

}  // namespace
}  // namespace crossnav::world
