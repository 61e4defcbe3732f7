// SPDX-License-Identifier: MIT
#include "crossnav/world/mesh/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "crossnav/world/mesh/coplanar.h"

namespace crossnav::world {
namespace {

constexpr double kMinExtent_m = 1e-4;  // chosen: thinner solids are dropped

Vector3d RingPoint(const Vector3d& base, double radius, int i, int sides) {
  const double angle = 2 * std::numbers::pi * i / sides;
  return base + radius * Vector3d(std::cos(angle), std::sin(angle), 0);
}

}  // namespace

std::uint32_t MeshBuilder::AddVertex(const Vector3d& p_part, const Vector3d& normal_part) {
  const Vector3d p_world = T_world_part * p_part;
  mesh_.vertices.push_back(p_world.cast<float>());
  // Part coordinates, so that a pattern rotates with its object.
  const Vector3d n = normal_part.cwiseAbs();
  Eigen::Vector2d uv(p_part.x(), p_part.y());
  if (n.x() > n.y() && n.x() > n.z()) uv = {p_part.y(), p_part.z()};
  if (n.y() >= n.x() && n.y() > n.z()) uv = {p_part.x(), p_part.z()};
  uv.x() /= texture_m;
  uv.y() /= texture_height_m > 0 ? texture_height_m : texture_m;
  mesh_.uvs.push_back({static_cast<float>(uv.x()), static_cast<float>(uv.y())});
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::PushTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh_.triangles.push_back({a, b, c});
  mesh_.triangle_material.push_back(static_cast<std::uint16_t>(material));
  mesh_.triangle_instance.push_back(instance);
}

void MeshBuilder::AddTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d n = (b - a).cross(c - a);
  if (n.norm() < 1e-12) return;
  const auto i = AddVertex(a, n), j = AddVertex(b, n), k = AddVertex(c, n);
  PushTriangle(i, j, k);
}

void MeshBuilder::AddQuad(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                          const Vector3d& d) {
  const Vector3d n = (c - a).cross(d - b);
  if (n.norm() < 1e-12) return;
  const auto i = AddVertex(a, n), j = AddVertex(b, n), k = AddVertex(c, n), l = AddVertex(d, n);
  PushTriangle(i, j, k);
  PushTriangle(i, k, l);
}

void MeshBuilder::AddPictureQuad(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                 const Vector3d& d) {
  const std::size_t first = mesh_.uvs.size();
  AddQuad(a, b, c, d);
  if (mesh_.uvs.size() != first + 4) return;  // too small to show a pattern
  constexpr float kIn = 0.004F;               // stays off the edge, where the texture repeats
  constexpr std::array<std::array<float, 2>, 4> kCorners = {
      {{kIn, 1 - kIn}, {1 - kIn, 1 - kIn}, {1 - kIn, kIn}, {kIn, kIn}}};
  std::copy(kCorners.begin(), kCorners.end(),
            mesh_.uvs.begin() + static_cast<std::ptrdiff_t>(first));
}

void MeshBuilder::AddBox(const Vector3d& min, const Vector3d& max) {
  if ((max - min).minCoeff() < kMinExtent_m) return;
  const auto at = [&](int x, int y, int z) {
    return Vector3d(x ? max.x() : min.x(), y ? max.y() : min.y(), z ? max.z() : min.z());
  };
  AddQuad(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
  AddQuad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  AddQuad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  AddQuad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  AddQuad(at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1));
  AddQuad(at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1));
}

void MeshBuilder::AddOrientedBox(const Vector3d& center, const Vector3d& size,
                                 const Eigen::Matrix3d& rotation) {
  const Pose before = T_world_part;
  T_world_part.translate(center);
  T_world_part.rotate(rotation);
  AddBox(-0.5 * size, 0.5 * size);
  T_world_part = before;
}

void MeshBuilder::AddPrism(std::span<const Eigen::Vector2d> base_xy, double z0, double z1) {
  const std::size_t n = base_xy.size();
  if (n < 3 || z1 - z0 < kMinExtent_m) return;
  const auto at = [&](std::size_t i, double z) {
    return Vector3d(base_xy[i % n].x(), base_xy[i % n].y(), z);
  };
  for (std::size_t i = 0; i < n; ++i) {
    AddQuad(at(i, z0), at(i + 1, z0), at(i + 1, z1), at(i, z1));
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    AddTriangle(at(0, z1), at(i, z1), at(i + 1, z1));
    AddTriangle(at(0, z0), at(i + 1, z0), at(i, z0));
  }
}

void MeshBuilder::AddFrustum(const Vector3d& base, double r0, double r1, double height_m,
                             int sides) {
  const Vector3d top = base + Vector3d(0, 0, height_m);
  for (int i = 0; i < sides; ++i) {
    const Vector3d a = RingPoint(base, r0, i, sides), b = RingPoint(base, r0, i + 1, sides);
    const Vector3d c = RingPoint(top, r1, i + 1, sides), d = RingPoint(top, r1, i, sides);
    if (r0 > 0 && r1 > 0) {
      AddQuad(a, b, c, d);
    } else if (r1 <= 0) {
      AddTriangle(a, b, top);
    } else {
      AddTriangle(base, c, d);
    }
    if (r0 > 0) AddTriangle(base, b, a);
    if (r1 > 0) AddTriangle(top, d, c);
  }
}

void MeshBuilder::AddBar(const Vector3d& a, const Vector3d& b, double radius, int sides) {
  const double length = (b - a).norm();
  if (length < kMinExtent_m) return;
  const Pose before = T_world_part;
  T_world_part.translate(a);
  T_world_part.rotate(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), b - a));
  AddCylinder(Vector3d::Zero(), radius, length, sides);
  T_world_part = before;
}

void MeshBuilder::AddEllipsoid(const Vector3d& center, const Vector3d& radii, int sides) {
  const int rings = std::max(3, sides / 2);
  const auto at = [&](int ring, int side) {
    const double polar = std::numbers::pi * ring / rings;
    const double azimuth = 2 * std::numbers::pi * side / sides;
    const Vector3d unit(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                        -std::cos(polar));
    return Vector3d(center + radii.cwiseProduct(unit));
  };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sides; ++s) {
      if (r == 0) {
        AddTriangle(at(0, 0), at(1, s + 1), at(1, s));
      } else if (r + 1 == rings) {
        AddTriangle(at(r, s), at(r, s + 1), at(rings, 0));
      } else {
        AddQuad(at(r, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s));
      }
    }
  }
}

void MeshBuilder::AddCushion(const Vector3d& min, const Vector3d& max, double bevel_m) {
  const double b = std::min(bevel_m, 0.45 * (max - min).minCoeff());
  const auto ring = [&](double inset, double z) {
    return std::array<Vector3d, 4>{Vector3d(min.x() + inset, min.y() + inset, z),
                                   Vector3d(max.x() - inset, min.y() + inset, z),
                                   Vector3d(max.x() - inset, max.y() - inset, z),
                                   Vector3d(min.x() + inset, max.y() - inset, z)};
  };
  const std::array<std::array<Vector3d, 4>, 4> rings = {
      ring(0.5 * b, min.z()), ring(0, min.z() + 0.5 * b), ring(0, max.z() - b), ring(b, max.z())};
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      AddQuad(rings[r][i], rings[r][j], rings[r + 1][j], rings[r + 1][i]);
    }
  }
  AddQuad(rings[3][0], rings[3][1], rings[3][2], rings[3][3]);
  AddQuad(rings[0][3], rings[0][2], rings[0][1], rings[0][0]);
}

void MeshBuilder::AddMesh(const sim::TriangleMesh& part, int material_offset) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (std::size_t i = 0; i < part.vertices.size(); ++i) {
    const Vector3d p_world = T_world_part * part.vertices[i].cast<double>();
    mesh_.vertices.push_back(p_world.cast<float>());
    mesh_.uvs.push_back(part.uvs.empty() ? std::array<float, 2>{0, 0} : part.uvs[i]);
  }
  for (std::size_t t = 0; t < part.triangles.size(); ++t) {
    const auto& tri = part.triangles[t];
    mesh_.triangles.push_back({tri[0] + first, tri[1] + first, tri[2] + first});
    mesh_.triangle_material.push_back(
        static_cast<std::uint16_t>(part.triangle_material[t] + material_offset));
    mesh_.triangle_instance.push_back(instance);
  }
}

void MeshBuilder::RemoveOverlaps() {
  mesh_ = WithoutOverlaps(std::move(mesh_));
}

}  // namespace crossnav::world
