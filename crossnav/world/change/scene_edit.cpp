// SPDX-License-Identifier: MIT
#include "crossnav/world/change/scene_edit.h"

#include <algorithm>
#include <map>

#include "crossnav/core/category_table.h"
#include "crossnav/core/check.h"

namespace crossnav::world {
namespace {

constexpr std::uint32_t kRemoved = ~std::uint32_t{0};

/// Copy of vertex `v` with all its attributes.
std::uint32_t CopyVertex(sim::TriangleMesh& mesh, std::uint32_t v) {
  mesh.vertices.push_back(mesh.vertices[v]);
  if (!mesh.uvs.empty()) mesh.uvs.push_back(mesh.uvs[v]);
  if (!mesh.vertex_colours.empty()) mesh.vertex_colours.push_back(mesh.vertex_colours[v]);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// Copies of the vertices of an instance, each once.
class OwnVertices {
 public:
  OwnVertices(sim::TriangleMesh& mesh, const Shift& shift) : mesh_(mesh), shift_(shift) {}

  std::uint32_t Of(std::uint32_t v) {
    const auto [at, is_new] = copy_of_.try_emplace(v, kRemoved);
    if (!is_new) return at->second;
    at->second = CopyVertex(mesh_, v);
    Vector3f& p = mesh_.vertices[at->second];
    p = shift_.Of(p.cast<double>()).cast<float>();
    return at->second;
  }

 private:
  sim::TriangleMesh& mesh_;
  const Shift& shift_;
  std::map<std::uint32_t, std::uint32_t> copy_of_;
};

template <class T, class IsOut>
void EraseByIndex(std::vector<T>& items, const IsOut& is_out) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!is_out(i)) items[kept++] = items[i];
  }
  items.resize(kept);
}

sim::SceneInstance* Find(sim::Scene& scene, int id) {
  const auto at = std::find_if(scene.instances.begin(), scene.instances.end(),
                               [id](const auto& instance) { return instance.id == id; });
  return at == scene.instances.end() ? nullptr : &*at;
}

void AddFace(sim::TriangleMesh& mesh, const std::array<Vector3d, 4>& corners, int id,
             std::uint16_t material) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3d& corner : corners) {
    mesh.vertices.push_back(corner.cast<float>());
    if (!mesh.uvs.empty()) mesh.uvs.push_back({0, 0});
    if (!mesh.vertex_colours.empty()) mesh.vertex_colours.push_back({255, 255, 255});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  for (int i = 0; i < 2; ++i) {
    mesh.triangle_material.push_back(material);
    mesh.triangle_instance.push_back(id);
  }
}

}  // namespace

Vector3d Shift::Of(const Vector3d& p_world) const {
  return pivot_world + Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) * (p_world - pivot_world) +
         by_world;
}

void MoveInstance(sim::Scene& scene, int id, const Shift& shift) {
  OwnVertices own(scene.mesh, shift);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (scene.mesh.triangle_instance[t] != id) continue;
    for (std::uint32_t& v : scene.mesh.triangles[t]) v = own.Of(v);
  }
}

int CopyInstance(sim::Scene& scene, int id, const Shift& shift) {
  const sim::SceneInstance* original = Find(scene, id);
  CROSSNAV_CHECK(original != nullptr, "an instance to copy exists");
  const std::string name = original->name, category = original->category;
  const int copy = AddInstance(scene, name, original->region);
  scene.instances.back().category = category;
  OwnVertices own(scene.mesh, shift);
  const std::size_t count = scene.mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    if (scene.mesh.triangle_instance[t] != id) continue;
    auto corners = scene.mesh.triangles[t];
    for (std::uint32_t& v : corners) v = own.Of(v);
    scene.mesh.triangles.push_back(corners);
    scene.mesh.triangle_material.push_back(scene.mesh.triangle_material[t]);
    scene.mesh.triangle_instance.push_back(copy);
  }
  return copy;
}

void RemoveInstance(sim::Scene& scene, int id) {
  RemoveTriangles(scene, id, [](const Vector3d&) { return true; });
  std::erase_if(scene.instances, [id](const auto& instance) { return instance.id == id; });
}

void RemoveTriangles(sim::Scene& scene, int id,
                     const std::function<bool(const Vector3d& centre_world)>& is_out) {
  sim::TriangleMesh& mesh = scene.mesh;
  std::vector<bool> out(mesh.triangles.size(), false);
  for (std::size_t t = 0; t < out.size(); ++t) {
    if (mesh.triangle_instance[t] != id) continue;
    Vector3d centre = Vector3d::Zero();
    for (const std::uint32_t v : mesh.triangles[t]) centre += mesh.vertices[v].cast<double>() / 3;
    out[t] = is_out(centre);
  }
  const auto is_gone = [&](std::size_t t) { return static_cast<bool>(out[t]); };
  EraseByIndex(mesh.triangles, is_gone);
  EraseByIndex(mesh.triangle_material, is_gone);
  EraseByIndex(mesh.triangle_instance, is_gone);
}

void AddBoard(sim::Scene& scene, int id, const Board& board, Rgb8 colour) {
  sim::Material material;
  material.colour = colour;
  auto same = std::find_if(scene.materials.begin(), scene.materials.end(), [&](const auto& m) {
    return m.texture < 0 && !m.is_unlit && m.colour == colour;
  });
  if (same == scene.materials.end()) same = scene.materials.insert(same, material);
  const auto index = static_cast<std::uint16_t>(same - scene.materials.begin());
  const Vector3d along = Eigen::AngleAxisd(board.yaw_rad, Vector3d::UnitZ()) * Vector3d::UnitX();
  const Vector3d across(-along.y(), along.x(), 0);
  const auto corner = [&](int x, int y, int z) -> Vector3d {
    return board.centre_world + along * (board.length_m * (x - 0.5)) +
           across * (board.thickness_m * (y - 0.5)) + Vector3d(0, 0, board.height_m * z);
  };
  constexpr int kFaces[6][4][3] = {
      {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {1, 1, 1}},
      {{0, 1, 0}, {0, 0, 0}, {0, 0, 1}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}},
      {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0}}};
  for (const auto& face : kFaces) {
    std::array<Vector3d, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = corner(face[i][0], face[i][1], face[i][2]);
    AddFace(scene.mesh, corners, id, index);
  }
}

int AddInstance(sim::Scene& scene, const std::string& name, int region) {
  int highest = 0;
  for (const auto& instance : scene.instances) highest = std::max(highest, instance.id);
  sim::SceneInstance instance;
  instance.id = highest + 1;
  instance.name = name;
  instance.region = region;
  const auto& table = DefaultCategories();
  if (const auto at = table.find(name); at != table.end()) instance.category = at->second;
  scene.instances.push_back(instance);
  return instance.id;
}

void Settle(sim::Scene& scene) {
  sim::TriangleMesh& mesh = scene.mesh;
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const auto& corners : mesh.triangles) {
    for (const std::uint32_t v : corners) is_used[v] = true;
  }
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), 0);
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    new_index[v] = kept;
    if (is_used[v]) ++kept;
  }
  for (auto& corners : mesh.triangles) {
    for (std::uint32_t& v : corners) v = new_index[v];
  }
  const auto is_gone = [&](std::size_t v) { return !is_used[v]; };
  EraseByIndex(mesh.vertices, is_gone);
  if (!mesh.uvs.empty()) EraseByIndex(mesh.uvs, is_gone);
  if (!mesh.vertex_colours.empty()) EraseByIndex(mesh.vertex_colours, is_gone);
  sim::UpdateDerived(scene);
}

}  // namespace crossnav::world
