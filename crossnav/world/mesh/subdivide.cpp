// SPDX-License-Identifier: MIT
#include "crossnav/world/mesh/subdivide.h"

#include <algorithm>
#include <map>

namespace crossnav::world {
namespace {

double AreaOf(const sim::TriangleMesh& mesh, std::size_t t) {
  const auto& k = mesh.triangles[t];
  const Vector3f &a = mesh.vertices[k[0]], &b = mesh.vertices[k[1]], &c = mesh.vertices[k[2]];
  return 0.5 * static_cast<double>((b - a).cross(c - a).norm());
}

/// Adds the midpoint of a and b.
std::uint32_t AddMiddle(sim::TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  const Vector3f middle = 0.5F * (mesh.vertices[a] + mesh.vertices[b]);
  mesh.vertices.push_back(middle);
  if (!mesh.uvs.empty()) {
    const std::array<float, 2> uv = {0.5F * (mesh.uvs[a][0] + mesh.uvs[b][0]),
                                     0.5F * (mesh.uvs[a][1] + mesh.uvs[b][1])};
    mesh.uvs.push_back(uv);
  }
  if (!mesh.vertex_colours.empty()) {
    const Rgb8 p = mesh.vertex_colours[a], q = mesh.vertex_colours[b];
    const auto mean = [](int x, int y) { return static_cast<std::uint8_t>((x + y) / 2); };
    mesh.vertex_colours.push_back({mean(p.r, q.r), mean(p.g, q.g), mean(p.b, q.b)});
  }
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

}  // namespace

void SubdivideWhere(sim::TriangleMesh& mesh, double max_edge_m,
                    const std::function<bool(std::size_t)>& wants) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;  // of edges
  for (std::size_t t = 0; t < mesh.triangles.size();) {
    const auto k = mesh.triangles[t];
    std::size_t longest = 0;
    float longest_m = -1;
    for (std::size_t e = 0; e < 3; ++e) {
      const float m = (mesh.vertices[k[e]] - mesh.vertices[k[(e + 1) % 3]]).norm();
      if (m <= longest_m) continue;
      longest_m = m;
      longest = e;
    }
    if (longest_m <= static_cast<float>(max_edge_m) || !wants(t)) {
      ++t;
      continue;
    }
    const auto a = k[longest], b = k[(longest + 1) % 3], c = k[(longest + 2) % 3];
    const auto [it, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, 0);
    if (is_new) it->second = AddMiddle(mesh, a, b);
    const std::uint32_t middle = it->second;
    mesh.triangles[t] = {a, middle, c};
    mesh.triangles.push_back({middle, b, c});
    mesh.triangle_material.push_back(std::uint16_t{mesh.triangle_material[t]});
    mesh.triangle_instance.push_back(std::int32_t{mesh.triangle_instance[t]});
  }
}

void Subdivide(sim::TriangleMesh& mesh, double max_edge_m, double min_area_m2) {
  SubdivideWhere(mesh, max_edge_m,
                 [&](std::size_t t) { return min_area_m2 <= 0 || AreaOf(mesh, t) > min_area_m2; });
}

}  // namespace crossnav::world
