// SPDX-License-Identifier: MIT
#include "open_scene.h"

namespace crossnav::app {

Result<OpenScene> OpenSceneFolder(const std::string& folder, const bench::RunConfig& config,
                                  Console& console) {
  auto scene = sim::LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  OpenScene open;
  open.scene = std::make_unique<sim::Scene>(std::move(*scene));
  for (const std::string& note : open.scene->notes) console.Log(open.scene->id + ": " + note);
  auto navmesh = sim::NavMesh::BuildCached(*open.scene, config.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  open.navmesh = std::make_unique<sim::NavMesh>(std::move(*navmesh));
  open.caster = std::make_unique<sim::RayCaster>(*open.scene);
  return open;
}

}  // namespace crossnav::app
