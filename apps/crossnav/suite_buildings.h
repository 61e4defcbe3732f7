// SPDX-License-Identifier: MIT
// Buildings of a suite's tracks, below a folder of scenes. Each function returns the mesh hash of
// each scene by its name.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "commands.h"
#include "crossnav/evaluation/episodes/suite.h"

namespace crossnav::app {

using MeshHashes = std::map<std::string, std::string>;

/// Houses of the first valid seeds, independent of the number of processes.
Result<MeshHashes> GenerateBuildings(const evaluation::SuiteDefinition& suite,
                                     const std::filesystem::path& scenes,
                                     const world::FurniturePack* pack, int jobs, Console& console);

/// The example homes in the archive `jar` of Sweet Home 3D. Error: no such file.
Result<MeshHashes> ImportDrawnHomes(const std::filesystem::path& jar,
                                    const std::filesystem::path& scenes, int jobs,
                                    Console& console);

/// Copies every scene below `from`, the output of `crossnav scene import`.
Result<MeshHashes> CopyBuildings(const std::filesystem::path& from,
                                 const std::filesystem::path& scenes, Console& console);

}  // namespace crossnav::app
