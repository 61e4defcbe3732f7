// SPDX-License-Identifier: MIT
// Binary glTF 2.0 -> one triangle mesh with all node transforms applied, in the FILE's own frame
// and units (scene.cpp turns it into the world frame). Reads PNG and JPEG images, and
// Basis images (GOOGLE_texture_basis, KHR_texture_basisu) where the build has their transcoder;
// else they are left out with a note and the material's flat colour is used.
// Every accessor is checked against its buffer before it is read; any bytes are safe to pass.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// A node that holds triangles, or one above it.
struct GltfPart {
  std::string name;  ///< the node's, else its mesh's; may be empty
  int parent = -1;   ///< index of the part above it
};

struct GltfModel {
  TriangleMesh mesh;  ///< file frame; uvs and vertex_colours are empty or one per vertex
  std::vector<Material> materials;  ///< never empty
  std::vector<Texture> textures;
  std::vector<std::string> notes;  ///< omissions, free text
  std::vector<GltfPart> parts;     ///< every node that was visited
  std::vector<int> triangle_part;  ///< per triangle
};

struct GltfOptions {
  /// COLOR_0 is linear light and becomes sRGB; true keeps its numbers, except for 16-bit numbers
  /// (colours of a semantic mesh are names; files that store them as light use 16 bits).
  bool raw_vertex_colours = false;
};

/// Binary glTF, or its JSON. `where` (a file name) prefixes errors; `folder` holds external images
/// and buffers, if any.
Result<GltfModel> ParseGlb(std::span<const std::uint8_t> bytes, const std::string& where,
                           const std::filesystem::path& folder, const GltfOptions& options = {});

Result<GltfModel> ReadGlb(const std::filesystem::path& file, const GltfOptions& options = {});

}  // namespace crossnav::sim
