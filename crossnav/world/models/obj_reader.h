// SPDX-License-Identifier: MIT
// Wavefront OBJ with MTL: positions, texture coordinates, faces of any number of corners, materials
// with diffuse colour, opacity and diffuse picture. File frame and units are kept. Missing pictures
// fall back to the material's colour.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

/// Returns the bytes of a file named by the OBJ or MTL, or nullopt if it does not exist.
using FileLookup = std::function<std::optional<std::string>(const std::string& name)>;

/// Drops triangles with a mostly transparent material (d < 0.15).
Result<ObjectModel> ParseObj(const std::string& text, const FileLookup& lookup,
                             const std::string& where);

/// Names of an OBJ file, in addition to its model.
struct NamedObj {
  ObjectModel model;
  std::vector<std::string> material_names;  ///< as model.materials; "" = before any usemtl
  std::vector<bool> is_material_defined;    ///< as model.materials: defined in an existing MTL
  std::vector<std::string> group_names;     ///< of "g" and "o" lines, without duplicates
  std::vector<int> triangle_group;          ///< per triangle, -1 = before any
};

/// As ParseObj, with the names; pictures keep up to `most_px`.
Result<NamedObj> ParseNamedObj(const std::string& text, const FileLookup& lookup,
                               const std::string& where, int most_px);

/// Pictures larger than `most_px` are reduced by whole factors.
sim::Texture Reduced(const sim::Texture& texture, int most_px);

}  // namespace crossnav::world
