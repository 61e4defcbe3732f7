// SPDX-License-Identifier: MIT
// A scene folder with its navmesh and camera, for the verbs that look at one scene.
#pragma once

#include <memory>
#include <string>

#include "commands.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::app {

struct OpenScene {
  std::unique_ptr<sim::Scene> scene;
  std::unique_ptr<sim::NavMesh> navmesh;
  std::unique_ptr<sim::RayCaster> caster;
};

/// Reads `folder`; what the reader left out goes to the log.
Result<OpenScene> OpenSceneFolder(const std::string& folder, const evaluation::RunConfig& config,
                                  Console& console);

struct SceneJob {
  evaluation::RunConfig config;
  OpenScene open;
};

/// Opens the scene in `folder` and makes the folder `out` for what a verb draws of it; nothing is
/// made where the scene or the settings are bad.
Result<SceneJob> OpenSceneJob(const std::string& folder, const std::string& out,
                              const CommonOptions& common, Console& console);

/// To a tenth of a millimetre: what JSON files of pictures hold.
double Rounded(double value);

}  // namespace crossnav::app
