// SPDX-License-Identifier: MIT
#include "suite_buildings.h"

#include <fmt/format.h>

#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/running/worker_pool.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/homes/scene_import.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/house/house_generator.h"
#include "crossnav/world/scene/scene_writer.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeeds = 500;  // chosen: seeds tried for a suite; most give a house

Result<std::string> MeshHashOf(const fs::path& folder) {
  const auto scene = sim::LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  return evaluation::HexHash(scene->mesh_hash);
}

Result<void> CopyScene(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  fs::copy(from, to, fs::copy_options::recursive, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), to.string());
  return {};
}

/// Generates the houses of `seeds` in worker processes; `passed` receives the mesh hash of each
/// accepted house.
Result<void> MakeHouses(const evaluation::SuiteDefinition& suite, const fs::path& scenes,
                        const std::vector<std::uint64_t>& seeds, const world::FurniturePack* pack,
                        int jobs, MeshHashes& passed, Console& console) {
  int done = 0;
  evaluation::PoolTask task;
  task.count = static_cast<int>(seeds.size());
  task.jobs = jobs;
  task.work = [&](int item) -> Result<std::string> {
    const auto params = suite.HouseOf(seeds[static_cast<std::size_t>(item)]);
    const auto house = world::GenerateHouse(params, scenes, pack);
    if (!house && house.error().code == ErrorCode::kInvalid) return std::string();  // next seed
    if (!house) return tl::unexpected(house.error());
    const auto scene = sim::LoadScene(house->folder);
    if (!scene) return tl::unexpected(scene.error());
    return house->scene_id + " " + evaluation::HexHash(scene->mesh_hash);
  };
  task.deliver = [&](int item, const evaluation::ItemAnswer& answer) -> Result<void> {
    if (answer.end != evaluation::ItemEnd::kDone) {
      return Fail(answer.error.code, answer.error.Message(),
                  fmt::format("house of seed {}", seeds[static_cast<std::size_t>(item)]));
    }
    console.Progress(fmt::format("house {} of {}", ++done, seeds.size()));
    const std::size_t blank = answer.text.find(' ');
    if (blank != std::string::npos) {
      passed[answer.text.substr(0, blank)] = answer.text.substr(blank + 1);
    }
    return {};
  };
  return evaluation::RunPool(task);
}

}  // namespace

Result<MeshHashes> GenerateBuildings(const evaluation::SuiteDefinition& suite,
                                     const fs::path& scenes, const world::FurniturePack* pack,
                                     int jobs, Console& console) {
  if (!evaluation::CanGenerate(suite)) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("needs edition {} of the generator, which this program does not have",
                            suite.generator_version),
                suite.name);
  }
  MeshHashes meshes;
  std::uint64_t next = suite.first_seed;
  while (static_cast<int>(meshes.size()) < suite.houses) {
    std::vector<std::uint64_t> seeds;
    if (next >= suite.first_seed + kSeeds) {
      return Fail(ErrorCode::kInvalid, "too few seeds give a house", suite.name);
    }
    for (int left = suite.houses - static_cast<int>(meshes.size()); left > 0; --left) {
      seeds.push_back(next++);
    }
    if (auto ok = MakeHouses(suite, scenes, seeds, pack, jobs, meshes, console); !ok) {
      return tl::unexpected(ok.error());
    }
  }
  return meshes;
}

Result<void> CheckHomesArchive(const fs::path& jar) {
  std::error_code error;
  if (fs::is_regular_file(jar, error)) return {};
  return Fail(ErrorCode::kNotFound,
              "no such file; install the package sweethome3d, or unpack it and name its "
              "sweethome3d.jar with --homes",
              jar.string());
}

Result<fs::path> ImportDrawnHome(const fs::path& jar, std::size_t home, int number,
                                 const fs::path& scenes) {
  homes::ImportOptions import;
  import.input = jar;
  import.out_dir = scenes;
  import.home = evaluation::DrawnHomes()[home];
  import.name = fmt::format("{:05}-{}", number, import.home);
  const auto report = homes::ImportScene(import);
  if (!report) return tl::unexpected(report.error());
  return report->folder;
}

Result<MeshHashes> ImportDrawnHomes(const fs::path& jar, const fs::path& scenes, int jobs,
                                    Console& console) {
  if (auto ok = CheckHomesArchive(jar); !ok) return tl::unexpected(ok.error());
  const auto homes = evaluation::DrawnHomes();
  MeshHashes meshes;
  evaluation::PoolTask task;
  task.count = static_cast<int>(homes.size());
  task.jobs = jobs;
  task.work = [&](int item) -> Result<std::string> {
    const auto folder = ImportDrawnHome(jar, static_cast<std::size_t>(item), item + 1, scenes);
    if (!folder) return tl::unexpected(folder.error());
    const auto hash = MeshHashOf(*folder);
    if (!hash) return tl::unexpected(hash.error());
    return folder->filename().string() + " " + *hash;
  };
  task.deliver = [&](int item, const evaluation::ItemAnswer& answer) -> Result<void> {
    if (answer.end != evaluation::ItemEnd::kDone)
      return Fail(answer.error.code, answer.error.Message(), homes[static_cast<std::size_t>(item)]);
    const std::size_t blank = answer.text.find(' ');
    meshes[answer.text.substr(0, blank)] = answer.text.substr(blank + 1);
    console.Progress(fmt::format("home {} of {}", meshes.size(), homes.size()));
    return {};
  };
  if (auto ok = evaluation::RunPool(task); !ok) return tl::unexpected(ok.error());
  return meshes;
}

Result<std::vector<fs::path>> ListBuildings(const std::string& from, const std::string& suite) {
  if (from.empty()) {
    return Fail(ErrorCode::kNotFound,
                "is made of buildings that you import (crossnav scene import); name the folder of "
                "their scenes with --buildings",
                suite);
  }
  const auto ids = evaluation::ListScenes(from);
  if (!ids) return tl::unexpected(ids.error());
  std::vector<fs::path> buildings;
  for (const std::string& id : *ids) buildings.push_back((fs::path(from) / id).parent_path());
  if (buildings.empty()) return Fail(ErrorCode::kNotFound, "no scene in it", from);
  return buildings;
}

Result<fs::path> CopyBuilding(const fs::path& building, int number, const fs::path& scenes) {
  const std::string id = building.filename().string();
  const auto dash = id.find('-');
  const std::string name = dash == std::string::npos ? id : id.substr(dash + 1);
  fs::path copy = scenes / fmt::format("{:05}-{}", number, name);
  if (auto ok = CopyScene(building, copy); !ok) return tl::unexpected(ok.error());
  return copy;
}

Result<MeshHashes> CopyBuildings(const std::string& from, const std::string& suite,
                                 const fs::path& scenes, Console& console) {
  const auto buildings = ListBuildings(from, suite);
  if (!buildings) return tl::unexpected(buildings.error());
  MeshHashes meshes;
  for (const fs::path& building : *buildings) {
    const std::string name = building.filename().string();
    if (meshes.contains(name))
      return Fail(ErrorCode::kInvalid, "two scenes are called " + name, from);
    const auto hash = MeshHashOf(building);
    if (!hash) return tl::unexpected(hash.error());
    if (auto ok = CopyScene(building, scenes / name); !ok) return tl::unexpected(ok.error());
    meshes[name] = *hash;
    console.Progress(fmt::format("building {} of {}", meshes.size(), buildings->size()));
  }
  if (auto ok = world::WriteDatasetConfig(scenes); !ok) return tl::unexpected(ok.error());
  return meshes;
}

}  // namespace crossnav::app
