// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/scene_info.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

const SceneInstance& Named(const Scene& scene, const char* name) {
  for (const SceneInstance& instance : scene.instances) {
    if (instance.name == name) return instance;
  }
  throw std::runtime_error("no such instance");
}

struct InfoWorld {
  Scene scene;
  RayCaster caster{scene};
  NavMesh navmesh;
  explicit InfoWorld(Scene s)
      : scene(std::move(s)), navmesh(std::move(*NavMesh::Build(scene, {}))) {}
  std::vector<Vector3d> ViewpointsOf(const char* name) const {
    return Viewpoints(scene, navmesh, caster, Named(scene, name), {});
  }
};

TEST(Viewpoints, SurroundAFreeStandingObjectOnTheGrid) {
  MicroScene m;
  m.Room(0, 0, 8, 8);
  m.Begin("chair", "chair");
  m.Box({4, 4, 0}, {4.5, 4.5, 0.9});
  const InfoWorld w(m.Finish());
  const auto points = w.ViewpointsOf("chair");
  const Box3& box = Named(w.scene, "chair").box;
  int quadrants[4] = {};
  for (const Vector3d& p : points) {
    EXPECT_LE(box.HorizontalDistance(p), 1.0 + 1e-9);
    EXPECT_NEAR(p.x() * 10, std::round(p.x() * 10), 1e-6);
    EXPECT_NEAR(p.y() * 10, std::round(p.y() * 10), 1e-6);
    EXPECT_TRUE(w.navmesh.Snap(p, 0.05, 0.05).has_value());
    ++quadrants[(p.x() > 4.25 ? 1 : 0) + (p.y() > 4.25 ? 2 : 0)];
  }
  // The ring between the object's own inset and 1 m from its box, in cells of 0.1 m.
  const double expected = (2.5 * 2.5 - (4 - 3.14159265) - 0.74 * 0.74) * 100;
  EXPECT_NEAR(static_cast<double>(points.size()), expected, 0.12 * expected);
  for (const int count : quadrants) EXPECT_NEAR(count, expected / 4, 0.2 * expected);
}

TEST(Viewpoints, AreNotBehindAWall) {
  MicroScene m;
  m.Room(0, 0, 8, 4);
  m.Begin("wall");
  m.Box({4, 0, 0}, {4.1, 3, 2.6});  // a gap at y > 3
  m.Begin("toilet", "toilet");
  m.Box({3.4, 0.5, 0}, {3.95, 1, 0.8});
  const InfoWorld w(m.Finish());
  const auto points = w.ViewpointsOf("toilet");
  EXPECT_FALSE(points.empty());
  for (const Vector3d& p : points) EXPECT_LT(p.x(), 4);
}

TEST(Viewpoints, BelongToTheStoreyOfTheObject) {
  const InfoWorld w(TwoFloors());
  const auto bed = w.ViewpointsOf("bed"), couch = w.ViewpointsOf("couch");
  ASSERT_FALSE(bed.empty());
  ASSERT_FALSE(couch.empty());
  for (const Vector3d& p : bed) EXPECT_NEAR(p.z(), 3, 0.1);
  for (const Vector3d& p : couch) EXPECT_NEAR(p.z(), 0, 0.1);
  EXPECT_EQ(FloorOfViewpoints(w.navmesh, bed), 1);
  EXPECT_EQ(FloorOfViewpoints(w.navmesh, couch), 0);
  EXPECT_EQ(FloorOfViewpoints(w.navmesh, {}), -1);
}

TEST(Viewpoints, AnObjectInsideACupboardHasNone) {
  MicroScene m;
  m.Room(0, 0, 6, 6);
  m.Begin("tv", "tv_monitor");
  m.Box({3, 3, 0.5}, {3.4, 3.4, 0.8});
  m.Begin("cupboard");
  m.Box({2.9, 2.9, 0}, {3.5, 3.5, 1.2});
  const InfoWorld w(m.Finish());
  EXPECT_TRUE(w.ViewpointsOf("tv").empty());
}

TEST(DescribeScene, ListsGoalInstancesPerCategory) {
  const InfoWorld w(TwoFloors());
  const SceneInfo info = DescribeScene(w.scene, w.navmesh, w.caster, {});
  EXPECT_EQ(info.scene, "micro");
  EXPECT_EQ(info.floors.size(), 2U);
  EXPECT_EQ(info.connections.size(), 1U);
  EXPECT_EQ(info.navmesh_hash, w.navmesh.Hash());
  ASSERT_EQ(info.instances.size(), 2U);
  EXPECT_EQ(info.instances.at("bed").at(0).floor, 1);
  EXPECT_EQ(info.instances.at("sofa").at(0).floor, 0);
  EXPECT_EQ(info.instances.at("sofa").at(0).name, "couch");
}

}  // namespace
}  // namespace crossnav::sim::test
