// SPDX-License-Identifier: MIT
// A scene folder with its navmesh and camera, for the verbs that look at one scene.
#pragma once

#include <memory>
#include <string>

#include "commands.h"
#include "crossnav/sim/navmesh.h"
#include "crossnav/sim/ray_caster.h"
#include "crossnav/sim/scene.h"

namespace crossnav::app {

struct OpenScene {
  std::unique_ptr<sim::Scene> scene;
  std::unique_ptr<sim::NavMesh> navmesh;
  std::unique_ptr<sim::RayCaster> caster;
};

/// Reads `folder`; what the reader left out goes to the log.
Result<OpenScene> OpenSceneFolder(const std::string& folder, const bench::RunConfig& config,
                                  Console& console);

}  // namespace crossnav::app
