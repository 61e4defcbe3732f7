// SPDX-License-Identifier: MIT
// Goals of episodes in other forms than a category, as GOAT-Bench mixes them: descriptions that
// mean one object, drawn from the scene's truth.
#pragma once

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/generation/episode_generator.h"

namespace crossnav::evaluation {

/// Describes each goal of the scene's episodes with the chance `share`; other goals stay. The
/// objects that are meant go into the file's goals_by_category under "<scene file>_<description>",
/// and `context` knows them from then on. Episodes whose described objects cannot be certified from
/// their start keep their categories. Returns how many goals are described.
Result<int> DescribeGoals(SceneContext& context, const std::string& scene_id, double share,
                          std::uint64_t seed, EpisodeFile& file);

}  // namespace crossnav::evaluation
