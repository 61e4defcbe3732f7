// SPDX-License-Identifier: MIT
#include "crossnav/world/mesh/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace crossnav::world {

void Simplify(ObjectModel& model, int budget) {
  auto& mesh = model.mesh;
  const double ratio = static_cast<double>(budget) / static_cast<double>(mesh.triangles.size());
  if (ratio >= 1) return;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> materials;
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    std::vector<unsigned int> indices;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.triangle_material[t] != m) continue;
      indices.insert(indices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    }
    if (indices.empty()) continue;
    std::vector<unsigned int> fewer(indices.size());
    const std::size_t triangle_count = indices.size() / 3;
    const auto wanted = static_cast<std::size_t>(ratio * static_cast<double>(triangle_count)) * 3;
    const std::size_t count = meshopt_simplify(
        fewer.data(), indices.data(), indices.size(), mesh.vertices[0].data(), mesh.vertices.size(),
        sizeof(Vector3f), std::min(indices.size(), std::max<std::size_t>(wanted, 24)), 0.05F, 0,
        nullptr);
    for (std::size_t i = 0; i + 2 < count; i += 3) {
      triangles.push_back({fewer[i], fewer[i + 1], fewer[i + 2]});
      materials.push_back(static_cast<std::uint16_t>(m));
    }
  }
  mesh.triangles = std::move(triangles);
  mesh.triangle_material = std::move(materials);
}

void Compact(ObjectModel& model) {
  auto& mesh = model.mesh;
  std::vector<std::uint32_t> index(mesh.vertices.size(), ~std::uint32_t{0});
  std::vector<Vector3f> vertices;
  std::vector<std::array<float, 2>> uvs;
  for (auto& t : mesh.triangles) {
    for (auto& v : t) {
      if (index[v] == ~std::uint32_t{0}) {
        index[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(mesh.vertices[v]);
        uvs.push_back(mesh.uvs[v]);
      }
      v = index[v];
    }
  }
  mesh.vertices = std::move(vertices);
  mesh.uvs = std::move(uvs);
  mesh.triangle_instance.assign(mesh.triangles.size(), 0);
}

}  // namespace crossnav::world
