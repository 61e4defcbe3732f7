// SPDX-License-Identifier: MIT
// Two homes drawn by people, in HM3D's layout, handed to the project from outside.
#include <gtest/gtest.h>

#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/scene_info.h"
#include "support/places.h"

namespace crossnav::sim::test {
namespace {

std::filesystem::path HomeFolder(const char* id) {
  return std::filesystem::path(crossnav::test::SharedPath("data/homes")) / id;
}

#define LOAD_HOME_OR_SKIP(scene, id)                                           \
  if (!std::filesystem::exists(HomeFolder(id))) GTEST_SKIP() << "no " << id;   \
  const auto scene##_result = LoadScene(HomeFolder(id));                       \
  ASSERT_TRUE(scene##_result.has_value()) << scene##_result.error().Message(); \
  const Scene& scene = *scene##_result

TEST(Homes, TheMezzanineHasTwoConnectedFloors) {
  LOAD_HOME_OR_SKIP(scene, "00901-HouseMezzanine");
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value());
  ASSERT_EQ(navmesh->Floors().size(), 2U);
  EXPECT_NEAR(navmesh->Floors()[1].height_m - navmesh->Floors()[0].height_m, 2.62, 0.1);
  ASSERT_EQ(navmesh->Connections().size(), 1U);
  Rng rng(1);
  for (int i = 0; i < 60; ++i) {  // everything that is kept is one piece
    EXPECT_TRUE(navmesh->Geodesic(*navmesh->RandomPoint(rng), *navmesh->RandomPoint(rng)));
  }
}

TEST(Homes, TheBungalowHasOneFloorInSpiteOfItsRoof) {
  LOAD_HOME_OR_SKIP(scene, "00904-House");
  const auto navmesh = NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value());
  EXPECT_EQ(navmesh->Floors().size(), 1U);
  EXPECT_TRUE(navmesh->Connections().empty());
}

TEST(Homes, EveryTriangleHasItsInstance) {
  for (const char* id : {"00901-HouseMezzanine", "00904-House"}) {
    LOAD_HOME_OR_SKIP(scene, id);
    int without = 0;
    for (const std::int32_t instance : scene.mesh.triangle_instance)
      without += instance == 0 ? 1 : 0;
    EXPECT_EQ(without, 0);
    EXPECT_TRUE(scene.notes.empty());
  }
}

TEST(Homes, GoalsHaveViewpointsOnTheirFloor) {
  LOAD_HOME_OR_SKIP(scene, "00901-HouseMezzanine");
  const auto navmesh = NavMesh::Build(scene, {});
  const RayCaster caster(scene);
  for (const SceneInstance& instance : scene.instances) {
    if (instance.category != "toilet" && instance.category != "tv_monitor") continue;
    const auto points = Viewpoints(scene, *navmesh, caster, instance, {});
    EXPECT_FALSE(points.empty()) << instance.id;
    EXPECT_EQ(FloorOfViewpoints(*navmesh, points), instance.box.min.z() < 2 ? 0 : 1) << instance.id;
  }
}

}  // namespace
}  // namespace crossnav::sim::test
