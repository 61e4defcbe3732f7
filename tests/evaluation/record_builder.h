// SPDX-License-Identifier: MIT
// Hand-made episode records for tests.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "crossnav/evaluation/records/episode_record.h"

namespace crossnav::evaluation::test {

struct StageOf {
  bool success;
  double shortest_m, length_m;
};

/// Goals are chair, bed, toilet, ... in order; failed stages are misdetections.
inline EpisodeRecord MakeEpisode(std::string id, int goals, const std::vector<StageOf>& stages) {
  static const std::vector<std::string> kNames = {"chair", "bed", "toilet", "plant"};
  EpisodeRecord episode;
  episode.episode_id = std::move(id);
  episode.scene_id = "house";
  for (int k = 0; k < goals; ++k) episode.goals.push_back(kNames[k % kNames.size()]);
  for (std::size_t k = 0; k < stages.size(); ++k) {
    StageRecord stage;
    stage.goal = episode.goals[k];
    stage.success = stages[k].success;
    stage.outcome = stage.success ? Outcome::kSuccess : Outcome::kMisdetection;
    stage.shortest_m = stages[k].shortest_m;
    stage.length_m = stages[k].length_m;
    episode.stages.push_back(stage);
  }
  return episode;
}

}  // namespace crossnav::evaluation::test
