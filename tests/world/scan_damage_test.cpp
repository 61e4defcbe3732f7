// SPDX-License-Identifier: MIT
#include "crossnav/world/surface/scan_damage.h"

#include <gtest/gtest.h>

#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/world/house/embedded_house.h"
#include "crossnav/world/mesh/subdivide.h"
#include "crossnav/world/shell/architecture.h"

namespace crossnav::world {
namespace {

double AreaOf(const sim::TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                   c = mesh.vertices[t[2]].cast<double>();
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

/// All faults off.
ScanDamage None() {
  ScanDamage damage;
  damage.holes_per_m2 = damage.noise_m = damage.blanks_per_m2 = 0;
  damage.floaters = 0;
  damage.mirror_share = damage.glass_share = damage.cut_share = 0;
  return damage;
}

/// A room 4 m square with a window in its south wall, a mirror on the north wall, a wardrobe that
/// nearly reaches the ceiling and a low box.
sim::Scene MakeRoom() {
  HousePlan plan;
  plan.id = "00001-Room";
  plan.levels = {{0, 2.5}};
  Room room;
  room.rects = {{0, 0, 4, 4}};
  plan.rooms.push_back(room);
  Wall south;
  south.a = {0, 0};
  south.b = {4, 0};
  south.room = 0;
  south.openings = {{OpeningKind::kWindow, 2, 1.2, 1.0, 2.0, true, true}};
  Wall north;
  north.a = {0, 4};
  north.b = {4, 4};
  north.room = 0;
  plan.walls = {south, north};
  const auto put = [&](const char* name, const Vector3d& size, const Vector3d& p) {
    ModelBuilder b(name);
    b.Colour({90, 90, 90});
    b.mesh.AddBox({-size.x() / 2, -size.y() / 2, 0}, {size.x() / 2, size.y() / 2, size.z()});
    plan.furniture.push_back({b.Finish(), StandAt(p, 0), 0});
  };
  put("mirror", {0.6, 0.03, 0.8}, {2, 3.92, 1.0});
  put("wardrobe", {1, 0.6, 2.2}, {0.6, 1, 0});
  put("box", {0.4, 0.4, 0.5}, {3.5, 1, 0});
  return BuildHouse(plan);
}

std::optional<sim::RayHit> Look(const sim::Scene& scene, const Vector3d& from, const Vector3d& to) {
  return sim::RayCaster(scene).Cast(from, to - from, 20);
}

const Box3& BoxOf(const sim::Scene& scene, std::string_view name) {
  for (const auto& i : scene.instances) {
    if (i.name == name) return i.box;
  }
  throw std::runtime_error("no such instance");
}

TEST(Subdivide, KeepsTheAreaAndShortensEveryEdge) {
  MeshBuilder b;
  b.AddBox({0, 0, 0}, {3, 2, 1});
  sim::TriangleMesh mesh = b.TakeMesh();
  mesh.vertex_colours.assign(mesh.vertices.size(), {10, 20, 30});
  const double before = AreaOf(mesh);
  Subdivide(mesh, 0.5);
  EXPECT_NEAR(AreaOf(mesh), before, 1e-4);
  EXPECT_EQ(mesh.triangle_instance.size(), mesh.triangles.size());
  EXPECT_EQ(mesh.uvs.size(), mesh.vertices.size());
  EXPECT_EQ(mesh.vertex_colours, std::vector<Rgb8>(mesh.vertices.size(), {10, 20, 30}));
  for (const auto& t : mesh.triangles) {
    for (std::size_t e = 0; e < 3; ++e) {
      EXPECT_LE((mesh.vertices[t[e]] - mesh.vertices[t[(e + 1) % 3]]).norm(), 0.5001F);
    }
  }
}

TEST(Subdivide, LeavesNarrowStripsWhole) {
  MeshBuilder b;
  b.AddQuad({0, 0, 0}, {3, 0, 0}, {3, 0.01, 0}, {0, 0.01, 0});
  sim::TriangleMesh mesh = b.TakeMesh();
  Subdivide(mesh, 0.5, 0.03);
  EXPECT_EQ(mesh.triangles.size(), 2U);
}

TEST(ScanDamage, DoesNothingWhereEverythingIsOff) {
  sim::Scene scene = MakeRoom();
  const double before = AreaOf(scene.mesh);
  DamageAsScan(scene, None());
  EXPECT_NEAR(AreaOf(scene.mesh), before, 1e-3);
  EXPECT_TRUE(Look(scene, {2, 2, 1.4}, {2, 5, 1.4}));
}

TEST(ScanDamage, AMirrorIsAHoleThroughTheWall) {
  sim::Scene scene = MakeRoom();
  ASSERT_TRUE(Look(scene, {2, 2, 1.4}, {2, 5, 1.4}));
  ScanDamage damage = None();
  damage.mirror_share = 1;
  DamageAsScan(scene, damage);
  EXPECT_FALSE(Look(scene, {2, 2, 1.4}, {2, 5, 1.4}));
  EXPECT_TRUE(Look(scene, {2, 2, 0.5}, {2, 5, 0.5})) << "the wall below stays";
  EXPECT_TRUE(Look(scene, {1, 2, 1.4}, {1, 5, 1.4})) << "the wall beside stays";
}

TEST(ScanDamage, AWindowHasNoDepthButItsFrameHas) {
  sim::Scene scene = MakeRoom();
  ASSERT_TRUE(Look(scene, {1.7, 2, 1.5}, {1.7, -5, 1.5}));
  ScanDamage damage = None();
  damage.glass_share = 1;
  DamageAsScan(scene, damage);
  EXPECT_FALSE(Look(scene, {1.7, 2, 1.5}, {1.7, -5, 1.5}));
  EXPECT_TRUE(Look(scene, {1.42, 2, 1.5}, {1.42, -5, 1.5}));
}

TEST(ScanDamage, TallThingsEndBelowTheCeiling) {
  sim::Scene scene = MakeRoom();
  ScanDamage damage = None();
  damage.cut_share = 1;
  DamageAsScan(scene, damage);
  EXPECT_LT(BoxOf(scene, "wardrobe").max.z(), 2.3);
  EXPECT_GT(BoxOf(scene, "wardrobe").max.z(), 1.7);
  EXPECT_FALSE(Look(scene, {0.6, 3, 2.29}, {0.6, -1, 2.29}) &&
               Look(scene, {0.6, 3, 2.29}, {0.6, -1, 2.29})->p_world.y() > 0.5);
  EXPECT_NEAR(BoxOf(scene, "box").max.z(), 0.5, 1e-6);
}

TEST(ScanDamage, PatchesLoseTheirTextureAndKeepTheirName) {
  sim::Scene scene = MakeRoom();
  std::map<int, double> before, after;
  const auto sum = [](const sim::Scene& s, std::map<int, double>& area) {
    for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
      sim::TriangleMesh one = s.mesh;
      one.triangles = {s.mesh.triangles[t]};
      area[s.mesh.triangle_instance[t]] += AreaOf(one);
    }
  };
  sum(scene, before);
  ScanDamage damage = None();
  damage.blanks_per_m2 = 0.2;
  const std::size_t materials = scene.materials.size();
  DamageAsScan(scene, damage);
  sum(scene, after);
  for (const auto& [instance, area] : before) EXPECT_NEAR(after[instance], area, 1e-2);
  ASSERT_EQ(scene.materials.size(), materials + 1);
  EXPECT_EQ(scene.materials.back().texture, -1);
  const auto blank = static_cast<std::uint16_t>(materials);
  const auto count =
      std::count(scene.mesh.triangle_material.begin(), scene.mesh.triangle_material.end(), blank);
  EXPECT_GT(count, 10);
  EXPECT_LT(count, static_cast<long>(scene.mesh.triangles.size()));
}

TEST(ScanDamage, MakesHolesButLeavesTheGroundAndTheStair) {
  sim::Scene scene = BuildHouse(EmbeddedHousePlan());
  const double before = AreaOf(scene.mesh);
  sim::Scene holes_only = scene;
  ScanDamage only = None();
  only.holes_per_m2 = ScanDamage().holes_per_m2;
  DamageAsScan(holes_only, only);
  EXPECT_LT(AreaOf(holes_only.mesh), before * 0.999);
  EXPECT_GT(AreaOf(holes_only.mesh), before * 0.9);
  DamageAsScan(scene, {});
  const auto navmesh = sim::NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh.has_value());
  EXPECT_EQ(navmesh->Floors().size(), 2U);
  EXPECT_EQ(navmesh->Connections().size(), 1U);
  sim::Scene again = BuildHouse(EmbeddedHousePlan());
  DamageAsScan(again, {});
  EXPECT_EQ(again.mesh.triangles, scene.mesh.triangles);
  sim::Scene other = BuildHouse(EmbeddedHousePlan());
  ScanDamage another_seed;
  another_seed.seed = 2;
  DamageAsScan(other, another_seed);
  EXPECT_NE(other.mesh.triangles, scene.mesh.triangles);
}

}  // namespace
}  // namespace crossnav::world
