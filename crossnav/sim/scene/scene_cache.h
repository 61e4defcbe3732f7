// SPDX-License-Identifier: MIT
// Files that follow from a scene and cost time to make. They stand in the scene's folder, or, where
// that cannot be written to, in $XDG_CACHE_HOME/crossnav/scenes (~/.cache/...). Their names hold a
// hash of all that they follow from, so that scenes share the second place.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace crossnav::sim {

/// Where a file of this name may be, the scene's folder first; none for a scene without a folder.
std::vector<std::filesystem::path> CachePlaces(const std::filesystem::path& folder,
                                               const std::string& name);

/// Writes the file where that is possible; where it is not, the next program makes it anew.
void WriteCache(const std::filesystem::path& folder, const std::string& name,
                std::string_view bytes);

}  // namespace crossnav::sim
