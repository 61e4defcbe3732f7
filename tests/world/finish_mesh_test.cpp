// SPDX-License-Identifier: MIT
#include "crossnav/world/finish_mesh.h"

#include <gtest/gtest.h>

#include "crossnav/sim/navmesh.h"
#include "crossnav/world/architecture.h"
#include "crossnav/world/embedded_house.h"
#include "crossnav/world/textures.h"

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

TEST(Subdivide, KeepsTheAreaAndShortensEveryEdge) {
  MeshBuilder b;
  b.AddBox({0, 0, 0}, {3, 2, 1});
  sim::TriangleMesh mesh = b.TakeMesh();
  const double before = AreaOf(mesh);
  Subdivide(mesh, 0.5);
  EXPECT_NEAR(AreaOf(mesh), before, 1e-4);
  EXPECT_EQ(mesh.triangle_instance.size(), mesh.triangles.size());
  EXPECT_EQ(mesh.uvs.size(), mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    for (std::size_t e = 0; e < 3; ++e) {
      EXPECT_LE((mesh.vertices[t[e]] - mesh.vertices[t[(e + 1) % 3]]).norm(), 0.5001F);
    }
  }
}

TEST(AmbientOcclusion, CornersAreDarkerThanOpenGround) {
  SceneBuilder builder;
  builder.BeginInstance("floor", 0);
  builder.mesh.material = builder.Material({200, 200, 200});
  builder.mesh.AddQuad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
  builder.mesh.AddBox({0, 3.5, 0}, {4, 4, 2});
  sim::Scene scene = builder.Finish("00001-Corner");
  Subdivide(scene.mesh, 0.3);
  BakeAmbientOcclusion(scene);
  int open = 0, corner = 255;
  for (std::size_t v = 0; v < scene.mesh.vertices.size(); ++v) {
    const Vector3f p = scene.mesh.vertices[v];
    if (p.z() > 0.01F) continue;
    const int tone = scene.mesh.vertex_colours[v].r;
    if (p.y() < 0) open = std::max(open, tone);
    if (p.x() > 1 && p.x() < 3 && p.y() > 3.2F && p.y() < 3.5F) corner = std::min(corner, tone);
  }
  EXPECT_EQ(open, 255);
  EXPECT_LT(corner, 240);
}

TEST(ScanDamage, MakesHolesButLeavesTheGroundAndTheStair) {
  sim::Scene scene = BuildHouse(EmbeddedHousePlan());
  const double before = AreaOf(scene.mesh);
  sim::Scene holes_only = scene;
  ScanDamage only;
  only.noise_m = 0;
  only.floaters = 0;
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
}

TEST(Patterns, RepeatWithoutASeam) {
  for (Pattern pattern : {Pattern::kPlaster, Pattern::kCarpet}) {
    const auto texture = MakePattern(pattern, 3);
    int most = 0;
    for (int v = 0; v < texture.rgb.height; ++v) {
      const int jump =
          std::abs(int{texture.rgb.At(0, v).r} - int{texture.rgb.At(texture.rgb.width - 1, v).r});
      most = std::max(most, jump);
    }
    EXPECT_LT(most, 60);
  }
  EXPECT_TRUE(MakePattern(Pattern::kPlain, 1).rgb.empty());
}

}  // namespace
}  // namespace crossnav::world
