// SPDX-License-Identifier: MIT
// Imports models of Sweet Home 3D's furniture libraries (.sh3f), or of its own catalogue, into a
// pack: catalogue, OBJ, size fit, simplification, licence and author of each.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::world {

struct ImportReport {
  int models = 0;
  std::map<std::string, int> per_kind;
  long triangles = 0, original_triangles = 0;
  std::vector<std::string> skipped;  ///< id: reason
};

/// Reads every .sh3f in `libraries` (a folder), or one library (a .sh3f, or sweethome3d.jar with
/// the program's own catalogue), and writes the pack to `out_dir`. Models of FurnitureClasses only.
/// kNotFound without a library.
Result<ImportReport> ImportFurniture(const std::filesystem::path& libraries,
                                     const std::filesystem::path& out_dir);

}  // namespace crossnav::world
