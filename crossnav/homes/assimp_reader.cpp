// SPDX-License-Identifier: MIT
#include "crossnav/homes/assimp_reader.h"

#if CROSSNAV_WITH_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <exception>
#include <map>

#include "crossnav/sim/scene/image_codec.h"
#endif

namespace crossnav::homes {

#if CROSSNAV_WITH_ASSIMP
namespace {

constexpr int kMaxFurniturePicture_px = 256;  // chosen: furniture fills a part of a 640 px picture

std::uint8_t ToByte(float unit) {
  return static_cast<std::uint8_t>(std::lround(std::min(1.0F, std::max(0.0F, unit)) * 255));
}

int TextureOf(const aiMaterial& material, const world::FileLookup& lookup, world::NamedObj& out,
              std::map<std::string, int>& known) {
  aiString path;
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &path) != AI_SUCCESS) return -1;
  const auto [it, is_new] = known.try_emplace(path.C_Str(), -1);
  if (!is_new) return it->second;
  const auto bytes = lookup(path.C_Str());
  if (!bytes) return -1;
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
  auto picture = sim::DecodeImage({data, bytes->size()}, path.C_Str());
  if (!picture) return -1;
  out.model.textures.push_back(world::Reduced(*picture, kMaxFurniturePicture_px));
  return it->second = static_cast<int>(out.model.textures.size()) - 1;
}

/// Per material of the file: its index in `out`, -1 if it is nearly invisible.
std::vector<int> AddMaterials(const aiScene& scene, const world::FileLookup& lookup,
                              world::NamedObj& out) {
  std::vector<int> index;
  std::map<std::string, int> textures;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    const aiMaterial& material = *scene.mMaterials[i];
    float opacity = 1;
    if (material.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity < 0.15F) {
      index.push_back(-1);
      continue;
    }
    aiColor3D colour(0.8F, 0.8F, 0.8F);
    material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
    sim::Material m{{ToByte(colour.r), ToByte(colour.g), ToByte(colour.b)},
                    TextureOf(material, lookup, out, textures)};
    if (m.texture >= 0) m.colour = {255, 255, 255};
    index.push_back(static_cast<int>(out.model.materials.size()));
    out.model.materials.push_back(m);
    out.material_names.emplace_back(material.GetName().C_Str());
    out.is_material_defined.push_back(true);
  }
  return index;
}

void AddMesh(const aiMesh& mesh, int material, world::NamedObj& out) {
  if (material < 0) return;
  sim::TriangleMesh& to = out.model.mesh;
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    to.vertices.emplace_back(p.x, p.y, p.z);
    const bool has_uv = mesh.HasTextureCoords(0);
    to.uvs.push_back(
        has_uv ? std::array<float, 2>{mesh.mTextureCoords[0][v].x, 1 - mesh.mTextureCoords[0][v].y}
               : std::array<float, 2>{0, 0});
  }
  const int group = static_cast<int>(out.group_names.size());
  out.group_names.emplace_back(mesh.mName.C_Str());
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    to.triangles.push_back(
        {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    to.triangle_material.push_back(static_cast<std::uint16_t>(material));
    out.triangle_group.push_back(group);
  }
}

}  // namespace

Result<world::NamedObj> ParseWithAssimp(const std::string& bytes, const std::string& extension,
                                        const world::FileLookup& lookup, const std::string& where) {
  try {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(
        bytes.data(), bytes.size(),
        aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType,
        extension.c_str());
    if (scene == nullptr) return Fail(ErrorCode::kMalformed, importer.GetErrorString(), where);
    world::NamedObj out;
    const std::vector<int> materials = AddMaterials(*scene, lookup, out);
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
      const aiMesh& mesh = *scene->mMeshes[m];
      if (mesh.mMaterialIndex < materials.size())
        AddMesh(mesh, materials[mesh.mMaterialIndex], out);
    }
    for (const Vector3f& v : out.model.mesh.vertices) {
      if (!v.allFinite())
        return Fail(ErrorCode::kMalformed, "has a vertex that is not finite", where);
    }
    if (out.model.mesh.triangles.empty()) {
      return Fail(ErrorCode::kMalformed, "holds no triangles", where);
    }
    out.model.mesh.triangle_instance.assign(out.model.mesh.triangles.size(), 0);
    return out;
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kMalformed, e.what(), where);
  }
}
#else
Result<world::NamedObj> ParseWithAssimp(const std::string& /*bytes*/, const std::string& extension,
                                        const world::FileLookup& /*lookup*/,
                                        const std::string& where) {
  return Fail(ErrorCode::kUnsupported,
              "this program is built without Assimp, so ." + extension + " models are not read",
              where);
}
#endif

}  // namespace crossnav::homes
