// SPDX-License-Identifier: MIT
// A scene as read from a folder in HM3D's layout: triangles with colour and instance, and the
// instances' names. World frame: z up, x forward, metres (converted from the file in the reader).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/image.h"
#include "crossnav/core/result.h"

namespace crossnav::sim {

struct Texture {
  Image<Rgb8> rgb;
  MaskImage opaque;  ///< empty = opaque everywhere
};

struct Material {
  Rgb8 colour{200, 200, 200};
  int texture = -1;       ///< index into Scene::textures, or -1
  bool is_unlit = false;  ///< the colours already hold the light, as a scan's do
};

struct TriangleMesh {
  std::vector<Vector3f> vertices;         // [m], world
  std::vector<std::array<float, 2>> uvs;  // per vertex, or empty
  std::vector<Rgb8> vertex_colours;       // per vertex, or empty; multiplies the material
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> triangle_material;  // per triangle
  std::vector<std::int32_t> triangle_instance;   // per triangle, 0 = none
};

struct SceneInstance {
  int id = 0;            ///< > 0, as in the semantic text
  std::string name;      ///< raw name, e.g. "dining chair"
  std::string category;  ///< one of kCategories, or empty
  int region = 0;
  Box3 box;  ///< of its triangles [m]
};

struct Scene {
  std::string id;  ///< folder name, e.g. "00901-HouseMezzanine"
  std::filesystem::path folder;
  TriangleMesh mesh;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<SceneInstance> instances;  ///< sorted by id
  std::uint64_t mesh_hash = 0;           ///< of geometry and semantics
  std::vector<std::string> notes;        ///< omissions of the reader, e.g. Basis textures

  const SceneInstance* FindInstance(int id) const;
};

/// Fills in derived data: instance order and boxes, mesh_hash, missing per-triangle data. LoadScene
/// calls it; scenes built in code call it themselves.
void UpdateDerived(Scene& scene);

/// Raw semantic name -> category; exact names, never substrings.
using CategoryTable = std::map<std::string, std::string, std::less<>>;

/// The built-in table (config/categories.tsv).
const CategoryTable& DefaultCategories();
/// "raw name<TAB>category" lines, '#' comments.
Result<CategoryTable> ReadCategoryTable(const std::filesystem::path& path);

/// Reads `<folder>/<hash>.glb`, `.semantic.glb`, `.semantic.txt`. The semantic mesh's colours are
/// transferred to the rendered mesh's triangles by nearest surface where the two differ.
Result<Scene> LoadScene(const std::filesystem::path& folder,
                        const CategoryTable& categories = DefaultCategories());

/// Folder of scene `scene_id` below `scenes_dir` (any split folder; also Habitat's ids, e.g.
/// "hm3d/val/00800-TEEsavR23oF/TEEsavR23oF.basis.glb").
Result<std::filesystem::path> FindScene(const std::filesystem::path& scenes_dir,
                                        std::string_view scene_id);

}  // namespace crossnav::sim
