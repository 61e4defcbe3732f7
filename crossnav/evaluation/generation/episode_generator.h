// SPDX-License-Identifier: MIT
// Generates certified episodes (benchmark.md, "Episodes"): three different categories by default, a
// start on a floor away from the first goal, every stage solvable, a given share that requires a
// floor change. Seeded; rejects episodes that it cannot certify.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"

namespace crossnav::evaluation {

struct GeneratorOptions {
  int count = 0;
  double cross_floor_share = 0.3;  // chosen: the paper's 288 of 927
  std::uint64_t seed = 1;
  /// Number of episodes with their first transition at stage 1, 2, ...; empty = by the share.
  std::vector<int> first_transitions = {};
  /// Called after each episode with the number so far.
  std::function<void(int done)> drawn = [](int) {};
  /// Share, among episodes that require a floor change, in which every stage requires one
  /// (down-up-down); a scene without matching goals gives an episode with a single required change.
  double alternating_share = 0;
};

struct GeneratorScene {
  std::string scene_id;
  const SceneContext* context = nullptr;
};

/// `count` episodes over all scenes in turn; the first transitions are spread over the stages.
/// Error: names the episodes that could not be certified.
Result<EpisodeFile> GenerateEpisodes(std::span<const GeneratorScene> scenes,
                                     const RunConfig& config, const GeneratorOptions& options);

/// Loads the context of a scene; the previous context is released first.
using SceneLoader =
    std::function<Result<std::unique_ptr<SceneContext>>(const std::string& scene_id)>;

/// Scene by scene, with one scene in memory at a time; episodes that a scene cannot give are drawn
/// from the scenes after it, then once more from all. Draws other episodes than GenerateEpisodes.
/// `alternating_share` must be 0.
Result<EpisodeFile> GenerateByScene(std::span<const std::string> scene_ids, const SceneLoader& load,
                                    const RunConfig& config, const GeneratorOptions& options);

/// An episode with chosen goals from a chosen floor; `seed` picks the start. Error: not
/// certifiable.
Result<Episode> MakeEpisode(const GeneratorScene& scene, const RunConfig& config,
                            const std::vector<std::string>& goals, int start_floor,
                            std::uint64_t seed);

/// Whether each stage requires another floor than the stage before it, beginning with the start.
bool Alternates(const Episode& episode);

/// Entries of a scene in `goals_by_category`, for all its categories.
void AddGoalObjects(const GeneratorScene& scene, EpisodeFile& file);

}  // namespace crossnav::evaluation
