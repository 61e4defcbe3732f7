// SPDX-License-Identifier: MIT
#include "crossnav/world/scene/scene_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "crossnav/core/write_file.h"
#include "crossnav/world/scene/glb_writer.h"

namespace crossnav::world {
namespace fs = std::filesystem;
namespace {

struct NamedBytes {
  std::string name, bytes;  ///< without bytes: the file is removed
};

fs::path PartOf(const fs::path& folder, const NamedBytes& file) {
  return folder / (file.name + ".part");
}

/// Replaces all files or none. Readers recognise a scene by the last file: it is removed first and
/// written last, so that a scene never mixes old and new files.
Result<void> WriteTogether(const fs::path& folder, std::span<const NamedBytes> files) {
  std::error_code ignored;
  for (const NamedBytes& file : files) {
    auto written = WriteFileAtomically(PartOf(folder, file), file.bytes);
    if (written) continue;
    for (const NamedBytes& other : files) fs::remove(PartOf(folder, other), ignored);
    return tl::unexpected(
        Error{written.error().code, written.error().what, (folder / file.name).string()});
  }
  fs::remove(folder / files.back().name, ignored);
  for (const NamedBytes& file : files) {
    if (auto put = PutInPlace(PartOf(folder, file), folder / file.name); !put) return put;
    if (file.bytes.empty()) fs::remove(folder / file.name, ignored);
  }
  return {};
}

}  // namespace

std::string SemanticText(const sim::Scene& scene) {
  std::string text = "HM3D Semantic Annotations\n";
  for (const auto& instance : scene.instances) {
    std::string name = instance.name;
    std::replace(name.begin(), name.end(), '"', '\'');
    const Rgb8 c = SemanticColour(instance.id);
    text += fmt::format("{},{:02X}{:02X}{:02X},\"{}\",{}\n", instance.id, c.r, c.g, c.b, name,
                        instance.region);
  }
  return text;
}

Result<void> WriteDatasetConfig(const fs::path& dir) {
  std::vector<std::string> scenes;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(dir, error)) {
    const std::string id = entry.path().filename().string();
    const auto dash = id.find('-');
    if (dash == std::string::npos) continue;
    const std::string file = id.substr(dash + 1) + ".glb";
    if (fs::exists(entry.path() / file)) scenes.push_back(id + "/" + file);
  }
  if (error) return Fail(ErrorCode::kIo, error.message(), dir.string());
  std::sort(scenes.begin(), scenes.end());
  std::string list;
  for (const auto& s : scenes)
    list += fmt::format("{}\n        \"{}\"", list.empty() ? "" : ",", s);
  // Keys of Habitat's HM3D configuration; the colours are in vertices, not in a texture.
  const std::string text = R"({
  "stages": {
    "paths": {
      ".glb": [)" + list + R"(
      ]
    },
    "default_attributes": {
      "shader_type": "flat",
      "up": [0, 0, 1],
      "front": [0, 1, 0],
      "origin": [0, 0, 0],
      "semantic_up": [0, 0, 1],
      "semantic_front": [0, 1, 0],
      "semantic_descriptor_filename": "%%CONFIG_NAME_AS_ASSET_FILENAME%%.semantic.txt",
      "semantic_asset": "%%CONFIG_NAME_AS_ASSET_FILENAME%%.semantic.glb",
      "has_semantic_textures": false
    }
  },
  "objects": {},
  "light_setups": {},
  "scene_instances": {}
}
)";
  return WriteFileAtomically(dir / "crossnav.scene_dataset_config.json", text);
}

Result<fs::path> WriteScene(const sim::Scene& scene, const fs::path& dir,
                            const std::string& house_text, const std::string& changes_text) {
  const auto dash = scene.id.find('-');
  if (dash == std::string::npos || dash + 1 == scene.id.size()) {
    return Fail(ErrorCode::kInvalid, "a scene id reads <number>-<name>", scene.id);
  }
  if (scene.mesh.triangles.empty()) return Fail(ErrorCode::kInvalid, "no triangles", scene.id);
  fs::path folder = dir / scene.id;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), folder.string());
  const std::string stem = scene.id.substr(dash + 1);
  const NamedBytes files[] = {{stem + ".house.json", house_text},
                              {stem + ".changes.json", changes_text},
                              {stem + ".semantic.txt", SemanticText(scene)},
                              {stem + ".semantic.glb", EncodeSemanticGlb(scene)},
                              {stem + ".glb", EncodeRenderGlb(scene)}};
  if (auto ok = WriteTogether(folder, files); !ok) return tl::unexpected(ok.error());
  if (auto ok = WriteDatasetConfig(dir); !ok) return tl::unexpected(ok.error());
  return folder;
}

}  // namespace crossnav::world
