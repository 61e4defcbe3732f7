// SPDX-License-Identifier: MIT
// A 3D model of a whole home (OBJ, glTF) and the file that names its objects -> a scene in the
// world frame. Unnamed triangles belong to one instance "unknown".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/homes/objects_file.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::homes {

/// A model with the names of its parts, in the file's frame and units.
struct PartedModel {
  sim::TriangleMesh mesh;
  std::vector<sim::Material> materials;
  std::vector<sim::Texture> textures;
  struct Part {
    std::string name;
    int parent = -1;
  };
  std::vector<Part> parts;
  std::vector<int> triangle_part;  ///< -1 = none
  std::vector<std::string> notes;
};

/// .obj with its MTL and pictures in the same folder, .glb, .gltf.
Result<PartedModel> ReadPartedModel(const std::filesystem::path& file);

/// Objects claim the triangles of their parts (first come), then boxes claim the rest with its
/// centre inside. An object without triangles is an error that names it. `where` is the file of the
/// objects.
Result<sim::Scene> NameObjects(PartedModel model, const ObjectsFile& objects,
                               const std::string& where);

}  // namespace crossnav::homes
