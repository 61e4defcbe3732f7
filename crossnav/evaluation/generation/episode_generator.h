// SPDX-License-Identifier: MIT
// Makes certified episodes (benchmark.md, "Episodes"): three different categories by default, a
// start on a floor away from the first goal, every stage solvable, a given share that requires a
// floor change. Seeded; refuses what it cannot certify.
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
  /// How many episodes have their first transition at stage 1, 2, ...; empty = by the share.
  std::vector<int> first_transitions = {};
  /// Called after each episode with how many there are.
  std::function<void(int done)> drawn = [](int) {};
  /// Of those that require a floor change: the share in which every stage requires one, as
  /// down-up-down does; a scene without such goals gives an episode with a single required change.
  double alternating_share = 0;
};

struct GeneratorScene {
  std::string scene_id;
  const SceneContext* context = nullptr;
};

/// `count` episodes over all scenes, turn by turn; the first transitions of those that require one
/// are spread over the stages. Error: what could not be certified.
Result<EpisodeFile> GenerateEpisodes(std::span<const GeneratorScene> scenes,
                                     const RunConfig& config, const GeneratorOptions& options);

/// Makes the context of a scene; it is let go before the next one is made.
using SceneLoader =
    std::function<Result<std::unique_ptr<SceneContext>>(const std::string& scene_id)>;

/// The same scene by scene, with one of them in memory at a time; what one scene cannot give is
/// asked of those after it, and of all once more. Draws other episodes than GenerateEpisodes.
/// `alternating_share` must be 0.
Result<EpisodeFile> GenerateByScene(std::span<const std::string> scene_ids, const SceneLoader& load,
                                    const RunConfig& config, const GeneratorOptions& options);

/// An episode with chosen goals from a chosen floor; `seed` picks the start. Error: not
/// certifiable.
Result<Episode> MakeEpisode(const GeneratorScene& scene, const RunConfig& config,
                            const std::vector<std::string>& goals, int start_floor,
                            std::uint64_t seed);

/// Whether each stage requires another floor than the one before it, from the start on.
bool Alternates(const Episode& episode);

/// The `goals_by_category` entries of a scene, for all categories it holds.
void AddGoalObjects(const GeneratorScene& scene, EpisodeFile& file);

}  // namespace crossnav::evaluation
