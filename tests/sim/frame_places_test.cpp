// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/frame_places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

struct PlacesWorld {
  Scene scene;
  RayCaster caster{scene};
  NavMesh navmesh;
  explicit PlacesWorld(Scene s)
      : scene(std::move(s)), navmesh(std::move(*NavMesh::Build(scene, {}))) {}

  std::vector<FramePlace> Places(const FrameRules& rules) const {
    return FramePlaces(scene, navmesh, caster, rules);
  }
};

PlacesWorld RoomWithABed() {
  MicroScene m;
  m.Room(0, 0, 8, 8);
  m.Begin("bed", "bed");
  m.Box({6, 6, 0}, {7.5, 7.5, 0.6});
  return PlacesWorld(m.Finish());
}

TEST(FramePlaces, AreAsManyAsAskedForOnTheNavmeshAndTheSameForTheSameSeed) {
  const PlacesWorld w = RoomWithABed();
  FrameRules rules;
  rules.count = 40;
  const auto places = w.Places(rules), again = w.Places(rules);
  ASSERT_EQ(places.size(), 40U);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(places[i].pose.p_world, again[i].pose.p_world);
    EXPECT_EQ(places[i].pose.yaw_rad, again[i].pose.yaw_rad);
    EXPECT_TRUE(w.navmesh.Snap(places[i].pose.p_world, 0.05, 0.2));
    const double steps = RadToDeg(places[i].pose.pitch_rad) / 30;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::abs(steps), 1.001);
  }
  rules.seed = 2;
  EXPECT_NE(w.Places(rules)[0].pose.p_world, places[0].pose.p_world);
}

TEST(FramePlaces, LookTowardsAGoalWhereTheyAreForObjects) {
  const PlacesWorld w = RoomWithABed();
  FrameRules rules;
  rules.count = 30;
  rules.object_share = 1;
  for (const FramePlace& place : w.Places(rules)) {
    const Vector3d d = Vector3d(6.75, 6.75, 0.3) - place.pose.p_world;
    const double off = WrapAngle(std::atan2(d.y(), d.x()) - place.pose.yaw_rad);
    EXPECT_LE(std::abs(RadToDeg(off)), 25.001);
    EXPECT_LE(std::hypot(d.x(), d.y()), 4.501);
  }
}

}  // namespace
}  // namespace crossnav::sim::test
