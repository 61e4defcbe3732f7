// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/scene_cache.h"

#include <cstdlib>

#include "crossnav/core/write_file.h"

namespace crossnav::sim {
namespace {

namespace fs = std::filesystem;

/// Empty where the environment names no home.
fs::path CacheHome() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/') return fs::path(cache) / "crossnav" / "scenes";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home == '/') return fs::path(home) / ".cache" / "crossnav" / "scenes";
  return {};
}

}  // namespace

std::vector<fs::path> CachePlaces(const fs::path& folder, const std::string& name) {
  if (folder.empty()) return {};
  std::vector<fs::path> places = {folder / name};
  if (const fs::path home = CacheHome(); !home.empty()) places.push_back(home / name);
  return places;
}

void WriteCache(const fs::path& folder, const std::string& name, std::string_view bytes) {
  for (const fs::path& place : CachePlaces(folder, name)) {
    std::error_code ignored;
    if (place.parent_path() != folder) fs::create_directories(place.parent_path(), ignored);
    if (WriteFileAtomically(place, bytes)) return;
  }
}

}  // namespace crossnav::sim
