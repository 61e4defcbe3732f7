// SPDX-License-Identifier: MIT
// Runs episodes in worker processes: each record is written when its episode finishes, so that a
// run always ends and can be resumed. Records are in the order of completion; readers sort them
// (result_records.h).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {

struct Evaluation {
  std::vector<Episode> episodes;  ///< episodes to play
  int jobs = 1;                   ///< processes
  double episode_seconds = 0;     ///< eval.episode_seconds; 0 = no limit
  /// Plays one episode, in a worker.
  std::function<Result<EpisodeRecord>(const Episode& episode)> play;
  /// Called in this process after each record has been written.
  std::function<void(const EpisodeRecord& record)> finished = [](const EpisodeRecord&) {};
};

/// An episode with an error, a crashed worker or an exhausted time leaves a `failed` record and is
/// not an error; an episode that does not fit its scene (CheckPlayable, kMismatch) leaves a record
/// with the reason kInvalidEpisode. Errors: a file that cannot be written, a process that cannot be
/// started.
Result<void> Evaluate(const Evaluation& evaluation, ResultWriter& writer);

/// The episodes grouped by scene, in order of appearance.
std::vector<Episode> GroupedByScene(std::vector<Episode> episodes);

/// Part `index` of `count`: contiguous, so that few scenes are loaded.
std::vector<Episode> ShardOf(const std::vector<Episode>& episodes, int index, int count);

/// The episodes without a record.
std::vector<Episode> Remaining(const std::vector<Episode>& episodes,
                               std::span<const EpisodeRecord> finished);

}  // namespace crossnav::evaluation
