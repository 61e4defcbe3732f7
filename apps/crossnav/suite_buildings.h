// SPDX-License-Identifier: MIT
// Buildings of a suite's tracks, below a folder of scenes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "commands.h"
#include "crossnav/evaluation/episodes/suite.h"

namespace crossnav::app {

/// Mesh hash of each scene, by its name.
using MeshHashes = std::map<std::string, std::string>;

/// Houses of the first valid seeds, independent of the number of processes.
Result<MeshHashes> GenerateBuildings(const evaluation::SuiteDefinition& suite,
                                     const std::filesystem::path& scenes,
                                     const world::FurniturePack* pack, int jobs, Console& console);

/// Error: the archive of Sweet Home 3D is not there, with the remedy.
Result<void> CheckHomesArchive(const std::filesystem::path& jar);

/// Imports home `home` of evaluation::DrawnHomes as scene `<number>-<home>`; its folder.
Result<std::filesystem::path> ImportDrawnHome(const std::filesystem::path& jar, std::size_t home,
                                              int number, const std::filesystem::path& scenes);

/// The example homes in the archive `jar`. Error: as CheckHomesArchive.
Result<MeshHashes> ImportDrawnHomes(const std::filesystem::path& jar,
                                    const std::filesystem::path& scenes, int jobs,
                                    Console& console);

/// Folders of the scenes below `from`, the output of `crossnav scene import`, by name. Error: the
/// suite needs such a folder and none was named, with the remedy.
Result<std::vector<std::filesystem::path>> ListBuildings(const std::string& from,
                                                         const std::string& suite);

/// Copies the scene in the folder `building` as `<number>-<its name>`; the folder of the copy.
Result<std::filesystem::path> CopyBuilding(const std::filesystem::path& building, int number,
                                           const std::filesystem::path& scenes);

/// Copies every scene of ListBuildings under its own name. Error: as ListBuildings.
Result<MeshHashes> CopyBuildings(const std::string& from, const std::string& suite,
                                 const std::filesystem::path& scenes, Console& console);

}  // namespace crossnav::app
