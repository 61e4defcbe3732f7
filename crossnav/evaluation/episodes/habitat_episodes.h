// SPDX-License-Identifier: MIT
// Our episodes as Habitat-Lab's ObjectNav dataset reads them: one file for all scenes.
#pragma once

#include <filesystem>

#include "crossnav/evaluation/episodes/episodes.h"

namespace crossnav::evaluation {

/// Name of the scene dataset config beside the scenes (world::WriteDatasetConfig).
inline constexpr const char* kSceneDatasetConfig = "crossnav.scene_dataset_config.json";

/// An episode's goal is its first; the whole list, the certificate and the floors stand under
/// `info`, as Habitat-Lab refuses keys of an episode that it does not know. View points carry
/// `iou`, which Habitat-Lab asks for, as 1: ours are places that see the object, without a measure.
Result<void> WriteHabitatEpisodes(const std::filesystem::path& path, const EpisodeFile& file);

}  // namespace crossnav::evaluation
