// SPDX-License-Identifier: MIT
// Goals of episodes in other forms than a category, as GOAT-Bench mixes them: descriptions and
// pictures that mean one object, drawn from the scene's truth.
#pragma once

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/generation/episode_generator.h"

namespace crossnav::evaluation {

/// Chance of each kind of goal; the rest stay categories.
struct GoalMix {
  double descriptions = 0;
  double pictures = 0;
};

/// How many goals became of each kind.
struct MixedGoals {
  int descriptions = 0;
  int pictures = 0;
};

/// Replaces goals of the scene's episodes by descriptions and pictures. The objects that are meant
/// go into the file's goals_by_category under "<scene file>_<goal>", and `context` knows them from
/// then on. A goal whose kind cannot be drawn, and an episode that cannot be certified from its
/// start, keep their categories.
Result<MixedGoals> MixGoals(SceneContext& context, const std::string& scene_id, const GoalMix& mix,
                            std::uint64_t seed, EpisodeFile& file);

}  // namespace crossnav::evaluation
