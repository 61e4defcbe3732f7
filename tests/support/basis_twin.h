// SPDX-License-Identifier: MIT
// A GLB of ours as HM3D ships its own: PNG images encoded as .basis, stored bottom row first.
// For tests that are linked with BasisUniversal::Encoder.
#pragma once

#include <encoder/basisu_comp.h>

#include <nlohmann/json.hpp>

#include <cstring>
#include <span>
#include <string>

#include "crossnav/core/png_image.h"

namespace crossnav::test {

/// ETC1S at its best quality; `flags` of basis_compress besides, e.g. basisu::cFlagYFlip.
inline std::string EncodeBasis(const Image<Rgba8>& image, std::uint32_t flags) {
  static const bool is_ready = (basisu::basisu_encoder_init(), true);
  (void)is_ready;
  std::size_t size = 0;
  const auto width = static_cast<std::uint32_t>(image.width);
  void* data = basisu::basis_compress(image.data.front().data(), width,
                                      static_cast<std::uint32_t>(image.height), width,
                                      flags | basisu::cFlagSRGB | 255, 0, &size);
  if (data == nullptr) return {};
  std::string bytes(static_cast<const char*>(data), size);
  basisu::basis_free_data(data);
  return bytes;
}

inline void Append32(std::string& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(value >> shift));
}

/// `glb` with every image as .basis behind GOOGLE_texture_basis.
inline std::string BasisTwin(const std::string& glb, int* images = nullptr) {
  const auto word = [&glb](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, glb.data() + at, sizeof(value));
    return std::size_t{value};
  };
  auto json = nlohmann::json::parse(glb.substr(20, word(12)));
  const std::string bin = glb.substr(20 + word(12) + 8);
  std::vector<std::string> encoded(json["bufferViews"].size());
  for (auto& image : json["images"]) {
    const auto view = image["bufferView"].get<std::size_t>();
    const auto& where = json["bufferViews"][view];
    const auto* data =
        reinterpret_cast<const std::uint8_t*>(bin.data()) + where["byteOffset"].get<std::size_t>();
    const auto rgba = DecodePng(std::span(data, where["byteLength"].get<std::size_t>()), "image");
    encoded[view] = EncodeBasis(rgba.value(), basisu::cFlagYFlip);
    image["mimeType"] = "image/x-basis";
    if (images != nullptr) ++*images;
  }
  for (auto& texture : json["textures"]) {
    texture["extensions"]["GOOGLE_texture_basis"]["source"] = texture["source"];
    texture.erase("source");
  }
  json["extensionsUsed"] = json["extensionsRequired"] = {"GOOGLE_texture_basis"};
  std::string chunk;
  for (std::size_t i = 0; i < encoded.size(); ++i) {
    auto& view = json["bufferViews"][i];
    const std::string bytes =
        encoded[i].empty() ? bin.substr(view["byteOffset"], view["byteLength"]) : encoded[i];
    while (chunk.size() % 4 != 0) chunk.push_back('\0');
    view["byteOffset"] = chunk.size();
    view["byteLength"] = bytes.size();
    chunk += bytes;
  }
  while (chunk.size() % 4 != 0) chunk.push_back('\0');
  json["buffers"][0]["byteLength"] = chunk.size();
  std::string text = json.dump();
  while (text.size() % 4 != 0) text.push_back(' ');
  std::string out = "glTF";
  Append32(out, 2);
  Append32(out, 12 + 8 + text.size() + 8 + chunk.size());
  Append32(out, text.size());
  out += "JSON" + text;
  Append32(out, chunk.size());
  out.append("BIN\0", 4);
  return out + chunk;
}

}  // namespace crossnav::test
