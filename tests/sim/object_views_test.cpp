// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/object_views.h"

#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/sim/sensing/instance_scene.h"
#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

struct ViewsWorld {
  Scene scene;
  RayCaster caster{scene};
  NavMesh navmesh;
  explicit ViewsWorld(Scene s)
      : scene(std::move(s)), navmesh(std::move(*NavMesh::Build(scene, {}))) {}

  const SceneInstance& Named(const std::string& name) const {
    for (const SceneInstance& instance : scene.instances) {
      if (instance.name == name) return instance;
    }
    throw std::runtime_error("no such instance");
  }
  std::vector<ObjectView> ViewsOf(const std::string& name, const ViewRules& rules = {}) const {
    return GoodViews(scene, navmesh, caster, Named(name), rules);
  }
};

/// A chair of 0.5 x 0.5 x 0.9 m in the middle of an 8 m room.
MicroScene ChairInARoom() {
  MicroScene m;
  m.Room(0, 0, 8, 8);
  m.Begin("chair", "chair");
  m.Box({4, 4, 0}, {4.5, 4.5, 0.9});
  return m;
}

/// Reference: counts the object's pixels in the whole picture.
VisibleObject CountPixels(const ViewsWorld& w, const ObjectView& view, const SensorConfig& sensor) {
  const Frame frame =
      w.caster.Render(sensor.Intrinsics(), CameraPose(view.pose, sensor.camera_height_m));
  for (const VisibleObject& object : VisibleObjects(frame.instance, 1)) {
    if (object.instance == view.instance) return object;
  }
  return {};
}

TEST(GoodViews, StandAroundAFreeObjectFacingItAtTheAskedDistance) {
  const ViewsWorld w(ChairInARoom().Finish());
  const ViewRules rules;
  const auto views = w.ViewsOf("chair");
  ASSERT_EQ(views.size(), 4U);
  int quadrants[4] = {};
  for (const ObjectView& view : views) {
    const Vector3d d = Vector3d(4.25, 4.25, 0) - view.pose.p_world;
    EXPECT_NEAR(std::hypot(d.x(), d.y()), view.distance_m, 1e-9);
    EXPECT_GE(view.distance_m, rules.near_m);
    EXPECT_LE(view.distance_m, rules.far_m);
    EXPECT_NEAR(WrapAngle(view.pose.yaw_rad - std::atan2(d.y(), d.x())), 0, 1e-9);
    EXPECT_TRUE(w.navmesh.Snap(view.pose.p_world, 0.05, 0.05).has_value());
    ++quadrants[(d.x() > 0 ? 1 : 0) + (d.y() > 0 ? 2 : 0)];
  }
  for (const int count : quadrants) EXPECT_EQ(count, 1);
}

TEST(GoodViews, TellTheBoxAndThePixelsOfTheWholePicture) {
  const ViewsWorld w(ChairInARoom().Finish());
  const ViewRules rules;
  for (const ObjectView& view : w.ViewsOf("chair")) {
    const VisibleObject plain = CountPixels(w, view, rules.sensor);
    EXPECT_EQ(view.visible_px, plain.visible_px);
    EXPECT_EQ(view.box.u0, plain.box.u0);
    EXPECT_EQ(view.box.v0, plain.box.v0);
    EXPECT_EQ(view.box.u1, plain.box.u1);
    EXPECT_EQ(view.box.v1, plain.box.v1);
    EXPECT_GE(view.box.Area(), 640.0 * 640.0 / 64);
    EXPECT_NEAR(view.visible_fraction, 1, 0.02);  // not occluded
  }
}

TEST(GoodViews, AreNotWhereSomethingHidesMostOfTheObject) {
  MicroScene m = ChairInARoom();
  m.Begin("screen");
  m.Box({3.8, 3, 0}, {3.85, 5.5, 1.5});  // beside the chair, towards -x
  const ViewsWorld w(m.Finish());
  const auto views = w.ViewsOf("chair");
  ASSERT_FALSE(views.empty());
  for (const ObjectView& view : views) {
    EXPECT_GT(view.pose.p_world.x(), 3.8);
    EXPECT_GE(view.visible_fraction, 0.7);
  }
  ViewRules all;
  all.per_object = 1000;
  EXPECT_LT(w.ViewsOf("chair", all).size(),
            ViewsWorld(ChairInARoom().Finish()).ViewsOf("chair", all).size());
}

TEST(GoodViews, CountPartsOutsideThePictureAsHidden) {
  MicroScene m;
  m.Room(0, 0, 8, 8);
  m.Begin("tower", "chair");
  m.Box({4, 4, 0}, {4.3, 4.3, 2.5});  // its top is in the picture from 1.62 m on only
  const ViewsWorld w(m.Finish());
  ViewRules rules;
  rules.per_object = 1000;
  rules.min_visible = 0.99;
  const auto views = w.ViewsOf("tower", rules);
  ASSERT_FALSE(views.empty());
  for (const ObjectView& view : views) EXPECT_GT(view.distance_m, 1.6);
}

TEST(GoodViews, AreNoneForAnObjectInACupboardOrOnlySmallOnes) {
  MicroScene m;
  m.Room(0, 0, 6, 6);
  m.Begin("tv", "tv_monitor");
  m.Box({3, 3, 0.5}, {3.4, 3.4, 0.8});
  m.Begin("cupboard");
  m.Box({2.9, 2.9, 0}, {3.5, 3.5, 1.2});
  m.Begin("thimble", "plant");
  m.Box({1, 1, 0}, {1.05, 1.05, 0.05});
  const ViewsWorld w(m.Finish());
  EXPECT_TRUE(w.ViewsOf("tv").empty());
  EXPECT_TRUE(w.ViewsOf("thimble").empty());
}

TEST(VisibleObjects, ListsInstancesByIdWithTheirBoxes) {
  InstanceImage image(6, 4);
  image.At(1, 1) = 7;
  image.At(3, 2) = 7;
  image.At(5, 0) = 2;
  const auto objects = VisibleObjects(image, 1);
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].instance, 2);
  EXPECT_EQ(objects[1].instance, 7);
  EXPECT_EQ(objects[1].visible_px, 2);
  EXPECT_EQ(objects[1].box.u0, 1);
  EXPECT_EQ(objects[1].box.v0, 1);
  EXPECT_EQ(objects[1].box.u1, 4);
  EXPECT_EQ(objects[1].box.v1, 3);
  EXPECT_EQ(VisibleObjects(image, 2).size(), 1U);
}

TEST(ExtractInstance, KeepsItsTrianglesMaterialsAndTextures) {
  MicroScene m;
  m.Room(0, 0, 4, 4);
  const int id = m.Begin("plant", "plant");
  m.SetMaterial(2);
  m.Box({1, 1, 0}, {2, 2, 1});
  Scene scene = m.Finish();
  scene.materials = {{{1, 1, 1}, -1}, {{2, 2, 2}, 0}, {{3, 3, 3}, 1}};
  scene.textures.resize(2);
  scene.textures[1].rgb = RgbImage(5, 5);
  const Scene alone = ExtractInstance(scene, id);
  EXPECT_EQ(alone.mesh.triangles.size(), 12U);
  ASSERT_EQ(alone.materials.size(), 1U);
  EXPECT_EQ(alone.materials[0].colour, (Rgb8{3, 3, 3}));
  ASSERT_EQ(alone.textures.size(), 1U);
  EXPECT_EQ(alone.textures[0].rgb.width, 5);
}

}  // namespace
}  // namespace crossnav::sim::test
