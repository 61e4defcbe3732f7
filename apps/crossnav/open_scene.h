// SPDX-License-Identifier: MIT
// A scene folder with its navmesh and camera, for verbs on a single scene.
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

/// Reads `folder`; logs the reader's omissions.
Result<OpenScene> OpenSceneFolder(const std::string& folder, const evaluation::RunConfig& config,
                                  Console& console);

struct SceneJob {
  evaluation::RunConfig config;
  OpenScene open;
};

/// Opens the scene in `folder` and creates the folder `out` for a verb's drawings; creates nothing
/// if the scene or the settings are invalid.
Result<SceneJob> OpenSceneJob(const std::string& folder, const std::string& out,
                              const CommonOptions& common, Console& console);

/// Rounded to a tenth of a millimetre, for JSON files of pictures.
double Rounded(double value);

}  // namespace crossnav::app
