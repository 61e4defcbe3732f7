// SPDX-License-Identifier: MIT
#include "open_scene.h"

#include <cmath>
#include <filesystem>

#include "crossnav/evaluation/files/output_path.h"

namespace crossnav::app {

Result<OpenScene> OpenSceneFolder(const std::string& folder, const evaluation::RunConfig& config,
                                  Console& console) {
  auto scene = sim::LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  OpenScene open;
  open.scene = std::make_unique<sim::Scene>(std::move(*scene));
  for (const std::string& note : open.scene->notes) console.Log(open.scene->id + ": " + note);
  auto navmesh = sim::NavMesh::Open(*open.scene, config.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  open.navmesh = std::make_unique<sim::NavMesh>(std::move(*navmesh));
  open.caster = std::make_unique<sim::RayCaster>(*open.scene);
  return open;
}

Result<SceneJob> OpenSceneJob(const std::string& folder, const std::string& out,
                              const CommonOptions& common, Console& console) {
  if (auto ok = evaluation::CheckOutputFolder(out, "--out"); !ok) return tl::unexpected(ok.error());
  auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  auto open = OpenSceneFolder(folder, *config, console);
  if (!open) return tl::unexpected(open.error());
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) return Fail(ErrorCode::kIo, "cannot make the folder: " + error.message(), out);
  return SceneJob{std::move(*config), std::move(*open)};
}

double Rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

}  // namespace crossnav::app
