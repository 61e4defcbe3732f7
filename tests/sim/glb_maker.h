// SPDX-License-Identifier: MIT
// Writes small GLB files for the reader's tests, independently of the project's own writer.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace crossnav::sim::test {

class GlbMaker {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};

  /// Appends `values` as a buffer view; returns its index.
  template <class T>
  int View(const std::vector<T>& values) {
    while (bin_.size() % 4 != 0) bin_.push_back(0);
    const std::size_t offset = bin_.size(), size = values.size() * sizeof(T);
    bin_.resize(offset + size);
    if (size > 0) std::memcpy(bin_.data() + offset, values.data(), size);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  /// Accessor over `values`, `per_element` numbers each.
  template <class T>
  int Accessor(const std::vector<T>& values, int component_type, const char* type,
               std::size_t per_element, bool normalized = false) {
    nlohmann::json accessor = {{"bufferView", View(values)},
                               {"componentType", component_type},
                               {"count", values.size() / per_element},
                               {"type", type}};
    if (normalized) accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int Positions(const std::vector<float>& xyz) { return Accessor(xyz, kFloat, "VEC3", 3); }

  /// One mesh with one primitive, under one node of the scene.
  void AddMesh(const nlohmann::json& primitive, nlohmann::json node = nlohmann::json::object()) {
    json["meshes"].push_back({{"primitives", nlohmann::json::array({primitive})}});
    node["mesh"] = json["meshes"].size() - 1;
    AddRoot(node);
  }
  void AddRoot(const nlohmann::json& node) {
    json["nodes"].push_back(node);
    json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
  }

  std::vector<std::uint8_t> Bytes() const {
    nlohmann::json whole = json;
    if (!bin_.empty()) whole["buffers"] = {{{"byteLength", bin_.size()}}};
    std::string text = whole.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::vector<std::uint8_t> bin = bin_;
    while (bin.size() % 4 != 0) bin.push_back(0);
    std::vector<std::uint8_t> out;
    const auto word = [&out](std::uint32_t w) {
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(w >> (8 * i)));
    };
    word(0x46546C67);
    word(2);
    word(static_cast<std::uint32_t>(12 + 8 + text.size() + (bin.empty() ? 0 : 8 + bin.size())));
    word(static_cast<std::uint32_t>(text.size()));
    word(0x4E4F534A);
    out.insert(out.end(), text.begin(), text.end());
    if (!bin.empty()) {
      word(static_cast<std::uint32_t>(bin.size()));
      word(0x004E4942);
      out.insert(out.end(), bin.begin(), bin.end());
    }
    return out;
  }

  static constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;

 private:
  std::vector<std::uint8_t> bin_;
};

/// A unit square in the file's xy plane: four corners, indices of two triangles.
inline std::vector<float> SquareCorners() {
  return {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
}

}  // namespace crossnav::sim::test
