// SPDX-License-Identifier: MIT
#include "crossnav/world/scene/backs.h"

#include <array>
#include <map>
#include <set>
#include <utility>

namespace crossnav::world {
namespace {

using Point = std::array<float, 3>;

Point PointOf(const Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

/// Instances with an edge that is not run through as often in either direction, or with a volume
/// that is not positive.
std::set<std::int32_t> OpenInstances(const sim::TriangleMesh& mesh) {
  std::map<std::int32_t, std::map<std::pair<Point, Point>, int>> runs;  // by edge, low point first
  std::map<std::int32_t, double> volume_m3;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::int32_t id = mesh.triangle_instance[t];
    std::array<Vector3f, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.vertices[mesh.triangles[t][k]];
    volume_m3[id] += p[0].cast<double>().dot(p[1].cast<double>().cross(p[2].cast<double>())) / 6;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = PointOf(p[k]), b = PointOf(p[(k + 1) % 3]);
      if (a == b) continue;
      runs[id][a < b ? std::pair(a, b) : std::pair(b, a)] += a < b ? 1 : -1;
    }
  }
  std::set<std::int32_t> open;
  for (const auto& [id, edges] : runs) {
    bool is_closed = volume_m3[id] > 0;
    for (const auto& [edge, balance] : edges) is_closed = is_closed && balance == 0;
    if (!is_closed) open.insert(id);
  }
  return open;
}

}  // namespace

sim::Scene WithBacks(sim::Scene scene) {
  sim::TriangleMesh& mesh = scene.mesh;
  const auto open = OpenInstances(mesh);
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    if (!open.contains(mesh.triangle_instance[t])) continue;
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles.push_back({c, b, a});
    mesh.triangle_material.push_back(mesh.triangle_material[t]);
    mesh.triangle_instance.push_back(mesh.triangle_instance[t]);
  }
  return scene;
}

}  // namespace crossnav::world
