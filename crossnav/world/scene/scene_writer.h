// SPDX-License-Identifier: MIT
// Writes a scene in HM3D's layout, so that one reader serves both:
//   <dir>/<id>/<hash>.glb, <hash>.semantic.glb, <hash>.semantic.txt   with id = "<number>-<hash>"
//   <dir>/crossnav.scene_dataset_config.json                          for Habitat
// Every file is written under a temporary name and renamed: no file is half written, and no scene
// is half replaced by another scene.
#pragma once

#include <filesystem>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// Writes `scene` below `dir` (created if absent) and returns the scene's folder. `scene.id` must
/// be "<number>-<name>". A non-empty `house_text` goes into `<hash>.house.json`, a non-empty
/// `changes_text` into `<hash>.changes.json`.
Result<std::filesystem::path> WriteScene(const sim::Scene& scene, const std::filesystem::path& dir,
                                         const std::string& house_text = {},
                                         const std::string& changes_text = {});

/// Rewrites the data set file of `dir` so that it lists every scene below it.
Result<void> WriteDatasetConfig(const std::filesystem::path& dir);

/// The semantic text of a scene.
std::string SemanticText(const sim::Scene& scene);

}  // namespace crossnav::world
