// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/instance_scene.h"

namespace crossnav::sim {
namespace {

/// Index in `to` of the element `from[old]`, copied there on first use. `places` is the map of
/// copies.
template <class T>
int CopyOnce(const std::vector<T>& from, int old, std::map<int, int>& places, std::vector<T>& to) {
  const auto [it, is_new] = places.try_emplace(old, static_cast<int>(to.size()));
  if (is_new) to.push_back(from[static_cast<std::size_t>(old)]);
  return it->second;
}

}  // namespace

Scene ExtractInstance(const Scene& scene, int id) {
  Scene alone;
  const TriangleMesh& mesh = scene.mesh;
  std::map<int, int> materials, textures;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_instance[t] != id) continue;
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t old = mesh.triangles[t][k];
      corners[k] = static_cast<std::uint32_t>(alone.mesh.vertices.size());
      alone.mesh.vertices.push_back(mesh.vertices[old]);
      if (!mesh.uvs.empty()) alone.mesh.uvs.push_back(mesh.uvs[old]);
      if (!mesh.vertex_colours.empty()) {
        alone.mesh.vertex_colours.push_back(mesh.vertex_colours[old]);
      }
    }
    alone.mesh.triangles.push_back(corners);
    alone.mesh.triangle_instance.push_back(id);
    alone.mesh.triangle_material.push_back(static_cast<std::uint16_t>(
        CopyOnce(scene.materials, mesh.triangle_material[t], materials, alone.materials)));
  }
  for (Material& material : alone.materials) {
    if (material.texture < 0) continue;
    material.texture = CopyOnce(scene.textures, material.texture, textures, alone.textures);
  }
  return alone;
}

}  // namespace crossnav::sim
