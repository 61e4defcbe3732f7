// SPDX-License-Identifier: MIT
#include "crossnav/world/house/embedded_house.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/shell/architecture.h"
#include "oracle_walk.h"
#include "support/temp_folder.h"

namespace crossnav::world {
namespace {

/// Written once, read through the same reader as HM3D's files.
struct House {
  test::TempFolder dir;
  HousePlan plan = EmbeddedHousePlan();
  sim::Scene scene;
  std::optional<sim::NavMesh> navmesh;

  House() {
    const auto folder = WriteEmbeddedHouse(dir.path());
    auto read = sim::LoadScene(folder.value());
    scene = std::move(read.value());
    navmesh.emplace(std::move(sim::NavMesh::Build(scene, {}).value()));
  }
  static House& Get() {
    static House house;
    return house;
  }
};

TEST(EmbeddedHouse, HasTwoConnectedFloors) {
  const House& house = House::Get();
  ASSERT_EQ(house.navmesh->Floors().size(), 2U);
  ASSERT_EQ(house.navmesh->Connections().size(), 1U);
  EXPECT_NEAR(house.navmesh->Connections()[0].rise_m, 2.8, 0.11);
  for (const auto& floor : house.navmesh->Floors()) EXPECT_GT(floor.area_m2, 40);
}

TEST(EmbeddedHouse, EveryRoomIsReachableFromTheFrontDoor) {
  const House& house = House::Get();
  const Vector3d front_door(5.3, 0.8, 0);
  const auto start = house.navmesh->Snap(front_door);
  ASSERT_TRUE(start.has_value());
  for (const Room& room : house.plan.rooms) {
    bool is_reachable = false;
    const Rect r = room.rects[0].Grown(-0.4);
    const double z = house.plan.levels[static_cast<std::size_t>(room.level)].floor_m;
    for (double x = r.x0; x < r.x1 && !is_reachable; x += 0.3) {
      for (double y = r.y0; y < r.y1 && !is_reachable; y += 0.3) {
        const auto p = house.navmesh->Snap({x, y, z}, 0.1, 0.2);
        is_reachable = p && house.navmesh->Geodesic(*start, *p).has_value();
      }
    }
    EXPECT_TRUE(is_reachable) << room.name << " on level " << room.level;
  }
}

TEST(EmbeddedHouse, CategoriesForceFloorChangesBothWays) {
  std::map<std::string, std::set<int>> floors_of;
  for (const auto& instance : House::Get().scene.instances) {
    if (!instance.category.empty()) {
      floors_of[instance.category].insert(instance.box.min.z() > 2.5 ? 1 : 0);
    }
  }
  const std::map<std::string, std::set<int>> expected = {{"bed", {1}},      {"chair", {0}},
                                                         {"plant", {0, 1}}, {"sofa", {0}},
                                                         {"toilet", {1}},   {"tv_monitor", {0}}};
  EXPECT_EQ(floors_of, expected);
}

TEST(EmbeddedHouse, HasOneInstanceOfStairsAndItSpansTheStorey) {
  int count = 0;
  for (const auto& instance : House::Get().scene.instances) {
    if (instance.name != "stairs") continue;
    ++count;
    EXPECT_NEAR(instance.box.min.z(), 0, 1e-3);
    EXPECT_NEAR(instance.box.max.z(), 2.8 - 0.175, 1e-3);
  }
  EXPECT_EQ(count, 1);
}

TEST(EmbeddedHouse, FurnitureDoesNotIntersectAndLeavesTheStairFree) {
  const auto& plan = House::Get().plan;
  std::vector<Box3> boxes;
  for (const auto& p : plan.furniture) {
    Box3 box;
    for (const auto& v : p.model.mesh.vertices) box.Add(p.T_world_object * v.cast<double>());
    boxes.push_back(box);
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (plan.furniture[i].model.name == "rug") continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (plan.furniture[j].model.name == "rug") continue;
      const Vector3d shared =
          boxes[i].max.cwiseMin(boxes[j].max) - boxes[i].min.cwiseMax(boxes[j].min);
      EXPECT_LT(shared.minCoeff(), 0.021)  // drawers' handles may touch
          << plan.furniture[i].model.name << " in " << plan.furniture[j].model.name;
    }
    for (const Rect& r : plan.stairs[0].footprint) {
      const Rect floor{boxes[i].min.x(), boxes[i].min.y(), boxes[i].max.x(), boxes[i].max.y()};
      EXPECT_FALSE(floor.Overlaps(r)) << plan.furniture[i].model.name;
    }
  }
}

TEST(EmbeddedHouse, AFollowerWalksUpAndDownTheStair) {
  const House& house = House::Get();
  const sim::RayCaster caster(house.scene);
  sim::Simulator simulator(house.scene, *house.navmesh, caster, {}, {});
  const Vector3d living_room = house.navmesh->Snap({2.6, 0.8, 0}).value();
  const Vector3d bathroom = house.navmesh->Snap({8.0, 6.5, 2.8}).value();
  ASSERT_TRUE(simulator.Reset({living_room, 0.3, 0}).has_value());
  const WalkResult up = WalkTo(simulator, bathroom);
  EXPECT_TRUE(up.arrived) << up.remaining_m << " m left after " << up.actions;
  const WalkResult down = WalkTo(simulator, living_room);
  EXPECT_TRUE(down.arrived) << down.remaining_m << " m left after " << down.actions;
}

TEST(EmbeddedHouse, IsTheSameEveryTime) {
  EXPECT_EQ(EncodeRenderGlb(BuildHouse(EmbeddedHousePlan())),
            EncodeRenderGlb(BuildHouse(EmbeddedHousePlan())));
}

}  // namespace
}  // namespace crossnav::world
