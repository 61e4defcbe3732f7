// SPDX-License-Identifier: MIT
#include "crossnav/homes/model_store.h"

#include <algorithm>
#include <cctype>

#include "crossnav/homes/assimp_reader.h"
#include "crossnav/sim/scene/gltf_reader.h"
#include "crossnav/sim/scene/image_codec.h"
#include "crossnav/world/mesh/simplify.h"

namespace crossnav::homes {
namespace {

constexpr int kMaxModelPicture_px = 256;  // chosen: furniture fills a part of a 640 px picture
constexpr int kMaxWallPicture_px = 512;
constexpr std::size_t kBudget = 20'000;  // chosen: as the largest models in furniture packs
constexpr std::size_t kMaxTriangles = 2'000'000;  // chosen: of one model

std::string ExtensionOf(const std::string& name) {
  const auto dot = name.rfind('.');
  const auto slash = name.rfind('/');
  if (dot == name.npos || (slash != name.npos && dot < slash)) return "";
  std::string extension = name.substr(dot + 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// Format of the bytes by their signature; `otherwise` if that is unknown.
std::string FormatOf(const std::string& bytes, const std::string& otherwise) {
  if (bytes.rfind("PK\x03\x04", 0) == 0) return "zip";
  if (bytes.rfind("glTF", 0) == 0) return "glb";
  if (bytes.rfind("MM", 0) == 0 && otherwise != "obj") return "3ds";
  if (bytes.substr(0, 4096).find("<COLLADA") != bytes.npos) return "dae";
  return otherwise == "dae" || otherwise == "3ds" || otherwise == "lws" ? otherwise : "obj";
}

/// A name in a model file, in the archive's spelling.
std::string Joined(const std::string& folder, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  while (name.rfind("./", 0) == 0) name.erase(0, 2);
  return folder + name;
}

Result<world::NamedObj> FromGlb(const std::string& bytes, const std::string& where) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  // A folder that cannot exist: a model in an archive must not name files outside it.
  auto gltf = sim::ParseGlb({data, bytes.size()}, where, "/dev/null");
  if (!gltf) return tl::unexpected(gltf.error());
  world::NamedObj out;
  out.model.mesh = std::move(gltf->mesh);
  out.model.materials = std::move(gltf->materials);
  out.model.textures = std::move(gltf->textures);
  out.model.mesh.vertex_colours.clear();
  if (out.model.mesh.uvs.empty()) out.model.mesh.uvs.resize(out.model.mesh.vertices.size(), {0, 0});
  out.material_names.resize(out.model.materials.size());
  out.is_material_defined.assign(out.model.materials.size(), true);
  out.triangle_group.assign(out.model.mesh.triangles.size(), -1);
  return out;
}

/// The first model in an archive inside the archive (a zipped OBJ, a KMZ).
Result<world::NamedObj> FromZip(const std::string& bytes, const std::string& where) {
  auto zip = world::ZipReader::Parse(bytes, where);
  if (!zip) return tl::unexpected(zip.error());
  for (const char* wanted : {"obj", "glb", "dae", "3ds"}) {
    for (const std::string& name : zip->Names()) {
      if (ExtensionOf(name) != wanted) continue;
      if (zip->SizeOf(name) > (256U << 20)) continue;
      const auto text = zip->Read(name);
      if (!text) return tl::unexpected(text.error());
      const std::string folder = name.substr(0, name.rfind('/') + 1);
      const auto lookup = [&](const std::string& file) -> std::optional<std::string> {
        if (zip->SizeOf(Joined(folder, file)) > (64U << 20)) return std::nullopt;
        auto found = zip->Read(Joined(folder, file));
        if (!found) return std::nullopt;
        return std::move(*found);
      };
      if (FormatOf(*text, wanted) == "zip") break;
      return ParseModel(*text, lookup, std::string(where).append(": ").append(name));
    }
  }
  return Fail(ErrorCode::kUnsupported, "holds no model that is read", where);
}

/// Doors keep all triangles, because they need their named parts; other models are simplified.
void Lighten(world::NamedObj& obj) {
  const bool is_moving =
      std::any_of(obj.group_names.begin(), obj.group_names.end(),
                  [](const std::string& name) { return name.rfind("sweethome3d_", 0) == 0; });
  if (is_moving || obj.model.mesh.triangles.size() <= kBudget) return;
  world::Simplify(obj.model, static_cast<int>(kBudget));
  world::Compact(obj.model);
  obj.triangle_group.assign(obj.model.mesh.triangles.size(), -1);
}

void UseBuiltInColours(world::NamedObj& obj) {
  for (std::size_t i = 0; i < obj.model.materials.size(); ++i) {
    if (obj.is_material_defined[i]) continue;
    if (const auto colour = BuiltInColour(obj.material_names[i])) {
      obj.model.materials[i].colour = *colour;
    }
  }
}

}  // namespace

Result<world::NamedObj> ParseModel(const std::string& bytes, const world::FileLookup& lookup,
                                   const std::string& where) {
  const std::string format = FormatOf(bytes, ExtensionOf(where));
  if (format == "zip") return FromZip(bytes, where);
  if (format == "glb") return FromGlb(bytes, where);
  if (format != "obj") return ParseWithAssimp(bytes, format, lookup, where);
  auto obj = world::ParseNamedObj(bytes, lookup, where, kMaxModelPicture_px);
  if (obj) UseBuiltInColours(*obj);
  return obj;
}

const world::NamedObj* ModelStore::Find(const std::string& entry, std::string& why) {
  const auto [it, is_new] = models_.try_emplace(entry);
  Loaded& loaded = it->second;
  if (is_new) {
    const std::string folder = entry.substr(0, entry.rfind('/') + 1);
    const auto lookup = [&](const std::string& name) {
      return contents_.Read(Joined(folder, name));
    };
    const auto bytes = entry.empty() ? std::nullopt : contents_.Read(entry);
    if (!bytes) {
      loaded.why = "its model '" + entry + "' is not in the archive, or damaged";
    } else if (auto model = ParseModel(*bytes, lookup, entry); !model) {
      loaded.why = model.error().Message();
    } else if (model->model.mesh.triangles.size() > kMaxTriangles) {
      loaded.why = entry + ": has more than two million triangles";
    } else {
      loaded.model = std::move(*model);
      Lighten(*loaded.model);
    }
  }
  why = loaded.why;
  return loaded.model ? &*loaded.model : nullptr;
}

const sim::Texture* ModelStore::Picture(const std::string& entry) {
  const auto [it, is_new] = pictures_.try_emplace(entry);
  if (is_new) {
    if (const auto bytes = contents_.Read(entry)) {
      const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
      auto picture = sim::DecodeImage({data, bytes->size()}, entry);
      if (picture) it->second = world::Reduced(*picture, kMaxWallPicture_px);
    }
  }
  return it->second ? &*it->second : nullptr;
}

std::optional<Rgb8> BuiltInColour(const std::string& material) {
  // Chosen by the names and their use: these models come without an MTL file.
  static const std::map<std::string, Rgb8, std::less<>> kColours = {
      {"white", {242, 242, 240}},       {"white.001", {242, 242, 240}},
      {"flwhite", {240, 240, 238}},     {"flwhite1", {240, 240, 238}},
      {"archwhite", {236, 234, 228}},   {"archwhite2", {228, 226, 220}},
      {"flblonde", {214, 182, 132}},    {"flyellow", {232, 212, 120}},
      {"yellow", {232, 208, 60}},       {"yellowbrt", {248, 232, 90}},
      {"silver", {192, 194, 198}},      {"grey", {128, 128, 128}},
      {"ltgrey", {178, 178, 178}},      {"dkgrey", {80, 80, 82}},
      {"dkdkgrey", {44, 44, 46}},       {"flgrey", {132, 132, 132}},
      {"flltgrey", {190, 190, 190}},    {"fldkgrey", {72, 72, 74}},
      {"fldkdkgrey", {40, 40, 42}},     {"black", {18, 18, 20}},
      {"flblack", {18, 18, 20}},        {"yellow_green", {108, 150, 60}},
      {"amber", {206, 150, 66}},        {"bone", {226, 218, 196}},
      {"bone2", {226, 218, 196}},       {"iris", {92, 100, 168}},
      {"flbrown", {112, 78, 50}},       {"flltbrown", {160, 120, 82}},
      {"brown", {112, 72, 44}},         {"redwood", {128, 62, 44}},
      {"fltan", {210, 180, 140}},       {"tan", {210, 180, 140}},
      {"lighttan", {222, 200, 164}},    {"lighttan2", {222, 200, 164}},
      {"lighttannew", {222, 200, 164}}, {"dkblue", {30, 40, 110}},
      {"ship2", {120, 126, 134}},       {"flesh", {226, 184, 156}},
      {"brzskin", {186, 130, 96}},      {"red", {196, 32, 32}},
      {"dkred", {120, 20, 24}},         {"ruby", {158, 20, 50}},
      {"bluteal", {36, 132, 150}},      {"bluegrey", {110, 124, 140}},
      {"sky_blue", {132, 182, 222}},    {"lavendar", {188, 166, 212}},
      {"sand_stone", {206, 190, 158}},  {"florange", {230, 140, 48}},
      {"jetflame", {250, 160, 60}},     {"offwhite.warm", {238, 230, 214}},
  };
  const auto found = kColours.find(material);
  return found == kColours.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace crossnav::homes
