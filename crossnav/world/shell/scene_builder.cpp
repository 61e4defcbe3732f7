// SPDX-License-Identifier: MIT
#include "crossnav/world/shell/scene_builder.h"

#include <utility>

#include "crossnav/core/check.h"
#include "crossnav/world/surface/pictures.h"
#include "crossnav/world/surface/textures.h"

namespace crossnav::world {

int SceneBuilder::Material(Rgb8 colour, int texture) {
  const auto key = std::make_tuple(int{colour.r}, int{colour.g}, int{colour.b}, texture);
  const auto [it, is_new] =
      material_index_.try_emplace(key, static_cast<int>(scene_.materials.size()));
  if (is_new) scene_.materials.push_back({colour, texture});
  return it->second;
}

void SceneBuilder::Use(const SurfaceFinish& finish) {
  int texture = -1;
  if (has_textures && finish.pattern != Pattern::kPlain) {
    const auto [it, is_new] = pattern_texture_.try_emplace(finish.pattern, -1);
    if (is_new) it->second = AddTexture(MakePattern(finish.pattern, texture_seed));
    texture = it->second;
    mesh.texture_m = PatternSize(finish.pattern);
  }
  mesh.material = Material(finish.colour, texture);
}

int SceneBuilder::AddTexture(sim::Texture texture) {
  scene_.textures.push_back(std::move(texture));
  return static_cast<int>(scene_.textures.size()) - 1;
}

int SceneBuilder::OutdoorMaterial() {
  constexpr std::size_t kViews = 3;  // chosen: enough that neighbouring windows differ
  const std::size_t view = windows_++ % kViews;
  if (view == outdoor_materials_.size()) {
    Rng rng(texture_seed, 500 + view);
    outdoor_materials_.push_back(Material({255, 255, 255}, AddTexture(MakeOutdoorTexture(rng))));
    glowing.insert(outdoor_materials_.back());
  }
  return outdoor_materials_[view];
}

int SceneBuilder::BeginInstance(std::string_view raw_name, int region) {
  sim::SceneInstance instance;
  instance.id = static_cast<int>(scene_.instances.size()) + 1;
  instance.name = raw_name;
  instance.region = region;
  scene_.instances.push_back(instance);
  mesh.instance = instance.id;
  return instance.id;
}

int SceneBuilder::Place(const ObjectModel& model, const Pose& T_world_object, int region) {
  const int id = BeginInstance(model.name, region);
  std::vector<int> material_of;
  std::vector<int> texture_of;
  const bool is_shared = !model.asset_id.empty();
  if (is_shared) texture_of = asset_textures_[model.asset_id];
  const std::size_t common = model.textures.size() - static_cast<std::size_t>(model.own_textures);
  for (std::size_t i = texture_of.size(); i < model.textures.size(); ++i) {
    texture_of.push_back(AddTexture(model.textures[i]));
    if (is_shared && i + 1 == common) asset_textures_[model.asset_id] = texture_of;
  }
  for (const auto& m : model.materials) {
    material_of.push_back(
        Material(m.colour, m.texture < 0 ? -1 : texture_of[static_cast<std::size_t>(m.texture)]));
  }
  for (int m : model.glowing) glowing.insert(material_of[static_cast<std::size_t>(m)]);
  sim::TriangleMesh part = model.mesh;
  for (auto& m : part.triangle_material) m = static_cast<std::uint16_t>(material_of[m]);
  mesh.T_world_part = T_world_object;
  mesh.AddMesh(part, 0);
  mesh.T_world_part = Pose::Identity();
  return id;
}

sim::Scene SceneBuilder::Finish(std::string_view id) {
  scene_.id = id;
  scene_.mesh = mesh.TakeMesh();
  std::vector<Box3> boxes(scene_.instances.size() + 1);
  for (std::size_t t = 0; t < scene_.mesh.triangles.size(); ++t) {
    const auto i = static_cast<std::size_t>(scene_.mesh.triangle_instance[t]);
    CROSSNAV_CHECK(i < boxes.size(), "triangle of an instance that was never begun");
    for (auto v : scene_.mesh.triangles[t]) boxes[i].Add(scene_.mesh.vertices[v].cast<double>());
  }
  std::vector<int> new_id(boxes.size(), 0);
  std::vector<sim::SceneInstance> kept;
  for (auto& instance : scene_.instances) {
    const auto i = static_cast<std::size_t>(instance.id);
    if (boxes[i].empty()) continue;
    instance.box = boxes[i];
    instance.id = new_id[i] = static_cast<int>(kept.size()) + 1;
    const auto& table = sim::DefaultCategories();
    if (const auto it = table.find(instance.name); it != table.end()) {
      instance.category = it->second;
    }
    kept.push_back(instance);
  }
  scene_.instances = std::move(kept);
  for (auto& i : scene_.mesh.triangle_instance) i = new_id[static_cast<std::size_t>(i)];
  return std::move(scene_);
}

}  // namespace crossnav::world
