// SPDX-License-Identifier: MIT
// `crossnav suite export SUITE --to habitat DIR`: a suite in the formats of Habitat-Sim and
// Habitat-Lab.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/episodes/habitat_episodes.h"
#include "crossnav/evaluation/episodes/suite.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/sim/navmesh/habitat_navmesh.h"
#include "crossnav/world/scene/backs.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/scene/scene_writer.h"
#include "session.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;

/// A scene: its mesh with backs and with colours as Habitat multiplies them, its semantics with
/// linear colours, and its navmesh.
Result<void> ExportScene(const fs::path& from, const fs::path& to,
                         const sim::NavMeshSettings& settings) {
  const auto scene = sim::LoadScene(from);
  if (!scene) return tl::unexpected(scene.error());
  const std::string stem = scene->id.substr(scene->id.find('-') + 1);
  const auto navmesh = sim::EncodeHabitatNavMesh(*scene, settings);
  if (!navmesh) return tl::unexpected(navmesh.error());
  std::error_code error;
  fs::create_directories(to, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), to.string());
  const auto write = [&](const char* ending, const std::string& bytes) {
    return WriteFileAtomically(to / (stem + ending), bytes);
  };
  if (auto ok = write(".navmesh", *navmesh); !ok) return ok;
  if (auto ok = write(".semantic.txt", world::SemanticText(*scene)); !ok) return ok;
  const sim::Scene backed = world::WithBacks(*scene);
  if (auto ok =
          write(".semantic.glb", world::EncodeSemanticGlb(backed, world::SemanticColours::kLinear));
      !ok) {
    return ok;
  }
  return write(".glb", world::EncodeRenderGlb(backed, world::RenderColours::kAsShown));
}

}  // namespace

Result<void> SuiteExport(const SuiteOptions& options, const CommonOptions& /*common*/,
                         Console& console) {
  const fs::path out(options.to.at(1));
  if (options.to.front() != "habitat") {
    return Fail(ErrorCode::kInvalid, "is no form to export to; there is habitat", "--to");
  }
  if (auto ok = evaluation::CheckOutputFolder(out, "--to"); !ok) return ok;
  const fs::path suite = fs::path(options.out) / options.name;
  const auto manifest = evaluation::ReadManifest(suite / "manifest.json");
  if (!manifest) {
    return Fail(
        manifest.error().code,
        manifest.error().what + "; make the suite first: crossnav suite make " + options.name,
        manifest.error().where);
  }
  const auto file = evaluation::ReadEpisodes(suite / "episodes.json.gz");
  if (!file) return tl::unexpected(file.error());
  const evaluation::RunConfig config;  // a suite does not depend on settings
  int done = 0;
  for (const auto& [scene, hash] : manifest->meshes) {
    console.Progress(fmt::format("scene {} of {}", ++done, manifest->meshes.size()));
    if (auto ok = ExportScene(suite / "scenes" / scene, out / "scenes" / scene, config.navmesh);
        !ok) {
      return ok;
    }
  }
  if (auto ok = world::WriteDatasetConfig(out / "scenes"); !ok) return ok;
  const fs::path episodes = out / "episodes.json.gz";
  if (auto ok = evaluation::WriteHabitatEpisodes(episodes, *file); !ok) return ok;
  console.EndProgress();
  console.Print(fmt::format("{}: {} scenes, {} episodes for Habitat\n", out.string(),
                            manifest->meshes.size(), file->episodes.size()));
  console.Document(nlohmann::ordered_json({{"folder", out.string()},
                                           {"scenes", manifest->meshes.size()},
                                           {"episodes", file->episodes.size()}}));
  return {};
}

}  // namespace crossnav::app
