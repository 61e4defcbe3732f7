// SPDX-License-Identifier: MIT
// The only user of nlohmann/json in this room besides scene_writer.cpp's text.
#include "crossnav/world/scene/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "crossnav/core/png_image.h"

namespace crossnav::world {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::size_t kMostShort = 65535;  // vertices; glTF reserves the last index
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123, kUnsignedByte = 5121;

double LinearOfSrgb(std::uint8_t byte) {
  const double s = byte / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::uint16_t Linear16(std::uint8_t srgb) {
  return static_cast<std::uint16_t>(std::lround(LinearOfSrgb(srgb) * 65535));
}

/// The binary chunk with its buffer views and accessors.
struct Buffers {
  std::string bytes;
  Json views = Json::array();
  Json accessors = Json::array();

  int AddView(const void* data, std::size_t size, int target) {
    while (bytes.size() % 4 != 0) bytes.push_back('\0');
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    views.push_back(std::move(view));
    bytes.append(static_cast<const char*>(data), size);
    return static_cast<int>(views.size()) - 1;
  }

  template <class T>
  int AddAccessor(const std::vector<T>& items, int component, const char* type, int target) {
    const int view = AddView(items.data(), items.size() * sizeof(T), target);
    accessors.push_back({{"bufferView", view},
                         {"componentType", component},
                         {"count", items.size()},
                         {"type", type}});
    return static_cast<int>(accessors.size()) - 1;
  }

  /// Two bytes each if `vertices` allows it.
  int AddIndices(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t vertices) {
    int a = 0;
    if (vertices <= kMostShort) {
      std::vector<std::array<std::uint16_t, 3>> narrow;
      narrow.reserve(triangles.size());
      for (const auto& t : triangles) {
        narrow.push_back({static_cast<std::uint16_t>(t[0]), static_cast<std::uint16_t>(t[1]),
                          static_cast<std::uint16_t>(t[2])});
      }
      a = AddAccessor(narrow, kUnsignedShort, "SCALAR", kElementArrayBuffer);
    } else {
      a = AddAccessor(triangles, kUnsignedInt, "SCALAR", kElementArrayBuffer);
    }
    accessors.back()["count"] = triangles.size() * 3;
    return a;
  }

  int AddPositions(const std::vector<Vector3f>& points_file) {
    const int a = AddAccessor(points_file, kFloat, "VEC3", kArrayBuffer);
    Vector3f lo = points_file.front(), hi = lo;
    for (const auto& p : points_file) {
      lo = lo.cwiseMin(p);
      hi = hi.cwiseMax(p);
    }
    accessors.back()["min"] = {lo.x(), lo.y(), lo.z()};
    accessors.back()["max"] = {hi.x(), hi.y(), hi.z()};
    return a;
  }
};

Vector3f FileOfWorld(const Vector3f& p_world) {
  return {-p_world.y(), p_world.x(), p_world.z()};
}

/// Triangle indices, grouped by material, in the order of the mesh within each.
std::vector<std::vector<std::uint32_t>> TrianglesByMaterial(const sim::Scene& scene) {
  std::vector<std::vector<std::uint32_t>> groups(scene.materials.size());
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    groups[scene.mesh.triangle_material[t]].push_back(t);
  }
  return groups;
}

std::string Finish(Json root, Buffers buffers) {
  while (buffers.bytes.size() % 4 != 0) buffers.bytes.push_back('\0');
  root["accessors"] = std::move(buffers.accessors);
  root["bufferViews"] = std::move(buffers.views);
  root["buffers"] = {{{"byteLength", buffers.bytes.size()}}};
  std::string json = root.dump(-1, ' ', false, Json::error_handler_t::replace);
  while (json.size() % 4 != 0) json.push_back(' ');

  std::string out;
  const auto put32 = [&out](std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
      out.push_back(static_cast<char>((value >> shift) & 0xff));
    }
  };
  out.append("glTF");
  put32(2);
  put32(12 + 8 + json.size() + 8 + buffers.bytes.size());
  put32(json.size());
  out.append("JSON");
  out.append(json);
  put32(buffers.bytes.size());
  out.append("BIN");
  out.push_back('\0');
  out.append(buffers.bytes);
  return out;
}

Json Root(Json primitives, Json materials) {
  Json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "crossnav"}};
  root["scene"] = 0;
  root["scenes"] = {{{"nodes", {0}}}};
  root["nodes"] = {{{"mesh", 0}}};
  root["meshes"] = {{{"primitives", std::move(primitives)}}};
  root["materials"] = std::move(materials);
  return root;
}

double FactorOf(std::uint8_t byte, RenderColours colours) {
  return colours == RenderColours::kLinear ? LinearOfSrgb(byte) : byte / 255.0;
}

Json MaterialJson(const sim::Scene& scene, const sim::Material& m, RenderColours colours) {
  Json pbr = {{"baseColorFactor",
               {FactorOf(m.colour.r, colours), FactorOf(m.colour.g, colours),
                FactorOf(m.colour.b, colours), 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 1.0}};
  Json material;
  if (m.texture >= 0) {
    pbr["baseColorTexture"] = {{"index", m.texture}};
    if (!scene.textures[static_cast<std::size_t>(m.texture)].opaque.empty()) {
      material["alphaMode"] = "MASK";
    }
  }
  material["pbrMetallicRoughness"] = std::move(pbr);
  material["doubleSided"] = true;
  if (m.is_unlit) material["extensions"] = {{"KHR_materials_unlit", Json::object()}};
  return material;
}

Json RenderPrimitive(const sim::Scene& scene, const std::vector<std::uint32_t>& group, int material,
                     RenderColours encoding, Buffers& buffers) {
  const auto& mesh = scene.mesh;
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kNone);
  std::vector<std::uint32_t> used;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (auto t : group) {
    std::array<std::uint32_t, 3> tri{};
    for (std::size_t k = 0; k < 3; ++k) {
      auto& index = new_index[mesh.triangles[t][k]];
      if (index == kNone) {
        index = static_cast<std::uint32_t>(used.size());
        used.push_back(mesh.triangles[t][k]);
      }
      tri[k] = index;
    }
    triangles.push_back(tri);
  }
  std::vector<Vector3f> points_file;
  points_file.reserve(used.size());
  for (auto v : used) points_file.push_back(FileOfWorld(mesh.vertices[v]));
  Json attributes = {{"POSITION", buffers.AddPositions(points_file)}};
  if (scene.materials[static_cast<std::size_t>(material)].texture >= 0) {
    std::vector<std::array<float, 2>> uvs;
    uvs.reserve(used.size());
    for (auto v : used) uvs.push_back(mesh.uvs[v]);
    attributes["TEXCOORD_0"] = buffers.AddAccessor(uvs, kFloat, "VEC2", kArrayBuffer);
  }
  if (!mesh.vertex_colours.empty()) {
    std::vector<std::array<std::uint16_t, 4>> colours;  // linear: 8 bits would lose the dark tones
    for (auto v : used) {
      const Rgb8 c = mesh.vertex_colours[v];
      const auto number = [encoding](std::uint8_t byte) {
        return encoding == RenderColours::kLinear ? Linear16(byte)
                                                  : static_cast<std::uint16_t>(byte * 257);
      };
      colours.push_back({number(c.r), number(c.g), number(c.b), 65535});
    }
    attributes["COLOR_0"] = buffers.AddAccessor(colours, kUnsignedShort, "VEC4", kArrayBuffer);
    buffers.accessors.back()["normalized"] = true;
  }
  const int indices = buffers.AddIndices(triangles, used.size());
  return {{"attributes", std::move(attributes)},
          {"indices", indices},
          {"material", material},
          {"mode", 4}};
}

void AddImages(const sim::Scene& scene, Json& root, Buffers& buffers) {
  if (scene.textures.empty()) return;
  root["samplers"] = {{{"magFilter", 9729}, {"minFilter", 9987}}};
  root["images"] = Json::array();
  root["textures"] = Json::array();
  for (const auto& texture : scene.textures) {
    const std::string png = EncodePng(texture.rgb, texture.opaque);
    const int view = buffers.AddView(png.data(), png.size(), 0);
    root["textures"].push_back({{"sampler", 0}, {"source", root["images"].size()}});
    root["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  }
}

/// Part of the semantic mesh that fits short indices.
struct SemanticPart {
  std::vector<Vector3f> points_file;
  std::vector<std::array<std::uint8_t, 4>> colours;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

int AddLinear(const std::vector<std::array<std::uint8_t, 4>>& bytes, Buffers& buffers) {
  std::vector<std::array<std::uint16_t, 4>> colours;
  for (const auto& c : bytes) {
    colours.push_back({Linear16(c[0]), Linear16(c[1]), Linear16(c[2]), 65535});
  }
  return buffers.AddAccessor(colours, kUnsignedShort, "VEC4", kArrayBuffer);
}

Json SemanticPrimitive(const SemanticPart& part, SemanticColours kind, Buffers& buffers) {
  Json attributes = {{"POSITION", buffers.AddPositions(part.points_file)}};
  attributes["COLOR_0"] =
      kind == SemanticColours::kLinear
          ? AddLinear(part.colours, buffers)
          : buffers.AddAccessor(part.colours, kUnsignedByte, "VEC4", kArrayBuffer);
  buffers.accessors.back()["normalized"] = true;
  const int indices = buffers.AddIndices(part.triangles, part.points_file.size());
  return {
      {"attributes", std::move(attributes)}, {"indices", indices}, {"material", 0}, {"mode", 4}};
}

}  // namespace

Rgb8 SemanticColour(int instance_id) {
  // An odd factor is a bijection modulo 2^24, so ids below 2^24 never collide.
  const auto c = (static_cast<std::uint32_t>(instance_id) * 0x9E3779u) & 0xFFFFFFu;
  return {static_cast<std::uint8_t>(c >> 16), static_cast<std::uint8_t>(c >> 8),
          static_cast<std::uint8_t>(c)};
}

std::string EncodeRenderGlb(const sim::Scene& scene, RenderColours colours) {
  Buffers buffers;
  Json primitives = Json::array(), materials = Json::array();
  const auto groups = TrianglesByMaterial(scene);
  for (std::size_t m = 0; m < groups.size(); ++m) {
    materials.push_back(MaterialJson(scene, scene.materials[m], colours));
    if (groups[m].empty()) continue;
    primitives.push_back(RenderPrimitive(scene, groups[m], static_cast<int>(m), colours, buffers));
  }
  Json root = Root(std::move(primitives), std::move(materials));
  const bool has_unlit = std::any_of(scene.materials.begin(), scene.materials.end(),
                                     [](const sim::Material& m) { return m.is_unlit; });
  if (has_unlit) root["extensionsUsed"] = {"KHR_materials_unlit"};
  AddImages(scene, root, buffers);
  return Finish(std::move(root), std::move(buffers));
}

std::string EncodeSemanticGlb(const sim::Scene& scene, SemanticColours colours) {
  const auto& mesh = scene.mesh;
  Buffers buffers;
  Json primitives = Json::array();
  SemanticPart part;
  // Repeats a vertex used by triangles of another instance or another primitive.
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kNone);
  std::vector<std::int32_t> instance_of(mesh.vertices.size(), -1);
  const auto flush = [&] {
    if (part.triangles.empty()) return;
    primitives.push_back(SemanticPrimitive(part, colours, buffers));
    part = {};
    std::fill(instance_of.begin(), instance_of.end(), -1);
  };
  for (const auto& group : TrianglesByMaterial(scene)) {
    for (auto t : group) {
      if (part.points_file.size() + 3 > kMostShort) flush();
      const int instance = mesh.triangle_instance[t];
      std::array<std::uint32_t, 3> tri{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = mesh.triangles[t][k];
        if (instance_of[v] != instance) {
          new_index[v] = static_cast<std::uint32_t>(part.points_file.size());
          instance_of[v] = instance;
          part.points_file.push_back(FileOfWorld(mesh.vertices[v]));
          const Rgb8 c = SemanticColour(instance);
          part.colours.push_back({c.r, c.g, c.b, 255});
        }
        tri[k] = new_index[v];
      }
      part.triangles.push_back(tri);
    }
  }
  flush();
  Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}}},
                   {"doubleSided", true},
                   {"extensions", {{"KHR_materials_unlit", Json::object()}}}};
  Json root = Root(std::move(primitives), Json::array({std::move(material)}));
  root["extensionsUsed"] = {"KHR_materials_unlit"};
  return Finish(std::move(root), std::move(buffers));
}

}  // namespace crossnav::world
