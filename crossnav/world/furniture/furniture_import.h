// SPDX-License-Identifier: MIT
// Imports models of Sweet Home 3D's furniture libraries (.sh3f) into a pack: catalogue, OBJ, size
// fit, simplification, licence and author of each.
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

/// Reads every .sh3f in `libraries` (a folder) and writes the pack to `out_dir`. Models of
/// FurnitureClasses only. kNotFound without a library.
Result<ImportReport> ImportFurniture(const std::filesystem::path& libraries,
                                     const std::filesystem::path& out_dir);

}  // namespace crossnav::world
