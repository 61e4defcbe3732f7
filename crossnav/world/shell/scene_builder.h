// SPDX-License-Identifier: MIT
// A scene under construction: one mesh, its materials (each colour and texture once) and its named
// instances. Finish() gives the same sim::Scene as the reader, so that written and read scenes can
// be compared.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

#include "crossnav/world/mesh/mesh_builder.h"
#include "crossnav/world/mesh/object_model.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::world {

class SceneBuilder {
 public:
  MeshBuilder mesh;
  bool has_textures = false;
  std::uint64_t texture_seed = 1;
  std::set<int> glowing;  ///< materials that emit light

  /// Index of the material; the same colour and texture give the same index.
  int Material(Rgb8 colour, int texture = -1);
  /// Makes the finish the current material, with its pattern if textures are on.
  void Use(const SurfaceFinish& finish);
  int AddTexture(sim::Texture texture);
  /// View through a window; one of a few views of the house.
  int OutdoorMaterial();

  /// Begins a new instance and returns its id (1, 2, ...).
  int BeginInstance(std::string_view raw_name, int region);

  /// Adds `model` at `T_world_object` as a new instance and returns its id.
  int Place(const ObjectModel& model, const Pose& T_world_object, int region);

  /// Drops instances without triangles and renumbers the others; categories come from the table.
  sim::Scene Finish(std::string_view id);

 private:
  sim::Scene scene_;
  std::map<std::tuple<int, int, int, int>, int> material_index_;
  std::map<Pattern, int> pattern_texture_;
  std::vector<int> outdoor_materials_;
  std::size_t windows_ = 0;
  std::map<std::string, std::vector<int>> asset_textures_;
};

}  // namespace crossnav::world
