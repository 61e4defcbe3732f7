// SPDX-License-Identifier: MIT
// Many episodes in worker processes: a record for each, written as soon as it is finished, so that
// a run always ends and can always be resumed. Records stand in the file in the order in which they
// were finished; readers sort them (result_records.h).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {

struct Evaluation {
  std::vector<Episode> episodes;  ///< what is to be done
  int jobs = 1;                   ///< processes
  double episode_seconds = 0;     ///< eval.episode_seconds; 0 = no limit
  /// Plays one episode, in a worker.
  std::function<Result<EpisodeRecord>(const Episode& episode)> play;
  /// Called in this process after each record has been written.
  std::function<void(const EpisodeRecord& record)> finished = [](const EpisodeRecord&) {};
};

/// An episode that errs, whose worker crashes or that runs out of its time leaves a `failed` record
/// and is no error; an episode that does not fit its scene (CheckPlayable, kMismatch) leaves
/// one with the reason kInvalidEpisode. Errors: a file that cannot be written, no process that can
/// be started.
Result<void> Evaluate(const Evaluation& evaluation, ResultWriter& writer);

/// The episodes, those of a scene together, scenes and episodes in the order of their appearance.
std::vector<Episode> GroupedByScene(std::vector<Episode> episodes);

/// Part `index` of `count`: neighbours stay together, so that few scenes are loaded.
std::vector<Episode> ShardOf(const std::vector<Episode>& episodes, int index, int count);

/// The episodes that have no record yet.
std::vector<Episode> Remaining(const std::vector<Episode>& episodes,
                               std::span<const EpisodeRecord> finished);

}  // namespace crossnav::evaluation
