// SPDX-License-Identifier: MIT
// Writes a scene in HM3D's layout, so that one reader serves both:
//   <dir>/<id>/<hash>.glb, <hash>.semantic.glb, <hash>.semantic.txt   with id = "<number>-<hash>"
//   <dir>/crossnav.scene_dataset_config.json                          for Habitat
// Every file is written beside its name first and renamed, so that none is ever half written, nor a
// scene half replaced by another one.
#pragma once

#include <filesystem>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// Writes `scene` below `dir` (made if absent) and returns the scene's folder. `scene.id` must read
/// "<number>-<name>". `house_text` goes into `<hash>.house.json`, `changes_text` into
/// `<hash>.changes.json`, where there is any.
Result<std::filesystem::path> WriteScene(const sim::Scene& scene, const std::filesystem::path& dir,
                                         const std::string& house_text = {},
                                         const std::string& changes_text = {});

/// Rewrites the data set file of `dir` so that it lists every scene below it.
Result<void> WriteDatasetConfig(const std::filesystem::path& dir);

/// The semantic text of a scene.
std::string SemanticText(const sim::Scene& scene);

}  // namespace crossnav::world
