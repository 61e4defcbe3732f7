// SPDX-License-Identifier: MIT
// Wavefront OBJ with MTL: positions, texture coordinates, faces (fans), materials with diffuse
// colour, opacity and diffuse picture. File frame and units are kept. Missing pictures fall back to
// the material's colour.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/world/object_model.h"

namespace crossnav::world {

/// Gives the bytes of a file named by the OBJ or MTL, or nullopt where it does not exist.
using FileLookup = std::function<std::optional<std::string>(const std::string& name)>;

/// Triangles whose material is mostly transparent (d < 0.15) are left out.
Result<ObjectModel> ParseObj(const std::string& text, const FileLookup& lookup,
                             const std::string& where);

/// Pictures larger than `most_px` are reduced by whole factors.
sim::Texture Reduced(const sim::Texture& texture, int most_px);

}  // namespace crossnav::world
