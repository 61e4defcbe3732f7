// SPDX-License-Identifier: MIT
#include "crossnav/world/mesh/mesh_builder.h"

#include <gtest/gtest.h>

#include <numbers>

namespace crossnav::world {
namespace {

/// By the divergence theorem; positive only where all faces are wound outwards and closed.
double SignedVolume(const sim::TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                   c = mesh.vertices[t[2]].cast<double>();
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

/// Sum of area vectors: zero for a closed surface.
double OpenArea(const sim::TriangleMesh& mesh) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                   c = mesh.vertices[t[2]].cast<double>();
    sum += 0.5 * (b - a).cross(c - a);
  }
  return sum.norm();
}

TEST(MeshBuilder, BoxHasItsVolumeAndFacesOutwards) {
  MeshBuilder b;
  b.AddBox({1, 2, 3}, {2, 4, 6});
  EXPECT_EQ(b.mesh().triangles.size(), 12U);
  EXPECT_NEAR(SignedVolume(b.mesh()), 6.0, 1e-5);
  EXPECT_NEAR(OpenArea(b.mesh()), 0, 1e-5);
}

TEST(MeshBuilder, RoundSolidsApproachTheirVolumes) {
  MeshBuilder cylinder, cone, ball, bar;
  cylinder.AddCylinder({1, 1, 1}, 0.5, 2, 64);
  EXPECT_NEAR(SignedVolume(cylinder.mesh()), std::numbers::pi * 0.25 * 2, 0.01);
  cone.AddFrustum({0, 0, 0}, 1, 0, 3, 64);
  EXPECT_NEAR(SignedVolume(cone.mesh()), std::numbers::pi, 0.02);
  ball.AddEllipsoid({0, 0, 5}, {1, 2, 3}, 48);
  EXPECT_NEAR(SignedVolume(ball.mesh()), 4.0 / 3 * std::numbers::pi * 6, 0.3);
  bar.AddBar({0, 0, 0}, {3, 0, 4}, 0.1, 32);
  EXPECT_NEAR(SignedVolume(bar.mesh()), std::numbers::pi * 0.01 * 5, 0.002);
  for (const auto* m : {&cylinder, &cone, &ball, &bar}) EXPECT_NEAR(OpenArea(m->mesh()), 0, 1e-4);
}

TEST(MeshBuilder, CushionAndPrismAreClosed) {
  MeshBuilder cushion, prism;
  cushion.AddCushion({0, 0, 0}, {1, 1, 0.2}, 0.05);
  EXPECT_NEAR(OpenArea(cushion.mesh()), 0, 1e-5);
  EXPECT_GT(SignedVolume(cushion.mesh()), 0.15);
  EXPECT_LT(SignedVolume(cushion.mesh()), 0.2);
  const std::vector<Vector2d> triangle = {{0, 0}, {2, 0}, {0, 1}};
  prism.AddPrism(triangle, 1, 4);
  EXPECT_NEAR(SignedVolume(prism.mesh()), 3.0, 1e-5);
  EXPECT_NEAR(OpenArea(prism.mesh()), 0, 1e-5);
}

TEST(MeshBuilder, TexturesKeepTheirRealSize) {
  MeshBuilder b;
  b.texture_m = 0.5;
  b.AddQuad({0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0});
  float span = 0;
  for (const auto& uv : b.mesh().uvs) span = std::max(span, uv[0]);
  EXPECT_FLOAT_EQ(span, 6.0F);  // 3 m at two repeats a metre
}

TEST(MeshBuilder, FlatSolidsAddNothing) {
  MeshBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 0});
  b.AddTriangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  b.AddBar({1, 1, 1}, {1, 1, 1}, 0.1);
  EXPECT_TRUE(b.mesh().triangles.empty());
}

TEST(Rect, SubtractKeepsTheAreaAndNeverOverlaps) {
  const Rect whole{0, 0, 10, 8};
  const std::vector<Rect> holes = {{2, 2, 4, 5}, {3, 1, 6, 3}, {9, 7, 12, 12}, {-5, -5, -1, -1}};
  const auto pieces = Subtract(whole, holes);
  double area = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    area += pieces[i].Area();
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(pieces[i].Overlaps(pieces[j]));
    for (const auto& hole : holes) EXPECT_FALSE(pieces[i].Overlaps(hole));
  }
  // 6 + 6 - 1 shared, and one square metre of the third inside.
  EXPECT_NEAR(area, 80 - 11 - 1, 1e-9);
}

}  // namespace
}  // namespace crossnav::world
