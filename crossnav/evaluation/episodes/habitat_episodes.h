// SPDX-License-Identifier: MIT
// Our episodes as Habitat-Lab's ObjectNav dataset reads them: one file for all scenes.
#pragma once

#include <filesystem>

#include "crossnav/evaluation/episodes/episodes.h"

namespace crossnav::evaluation {

/// Name of the scene dataset config beside the scenes (world::WriteDatasetConfig).
inline constexpr const char* kSceneDatasetConfig = "crossnav.scene_dataset_config.json";

/// The goal is the episode's first goal; the full list, the certificate and the floors are under
/// `info`, because Habitat-Lab refuses unknown keys of an episode. View points carry `iou` = 1,
/// which Habitat-Lab requires; ours have no such measure.
Result<void> WriteHabitatEpisodes(const std::filesystem::path& path, const EpisodeFile& file);

}  // namespace crossnav::evaluation
