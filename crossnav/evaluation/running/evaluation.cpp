// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/evaluation.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "crossnav/evaluation/running/worker_pool.h"

namespace crossnav::evaluation {
namespace {

/// True where the error is CheckPlayable's: the episode does not fit its scene.
bool IsInvalid(const Episode& episode, const Error& error) {
  return error.code == ErrorCode::kMismatch && error.where.starts_with(episode.where + ": ");
}

EpisodeFailure FailureOf(const Episode& episode, const ItemAnswer& answer, double episode_seconds) {
  switch (answer.end) {
    case ItemEnd::kCrash:
      return {"crash", answer.error.Message()};
    case ItemEnd::kTime:
      return {"time", fmt::format("took longer than eval.episode_seconds = {:g}", episode_seconds)};
    case ItemEnd::kError:
      if (IsInvalid(episode, answer.error))
        return {std::string(kInvalidEpisode), answer.error.Message()};
      break;
    case ItemEnd::kDone:
      break;
  }
  return {"error", answer.error.Message()};
}

EpisodeRecord FailedRecord(const Episode& episode, EpisodeFailure failure) {
  EpisodeRecord record;
  record.episode_id = episode.episode_id;
  record.scene_id = episode.scene_id;
  record.track = episode.track;
  record.cross_floor_required = episode.cross_floor_required;
  record.first_transition_stage = episode.first_transition_stage;
  record.goals = episode.goals;
  record.failed = std::move(failure);
  return record;
}

/// A number for each scene, in the order of appearance.
std::vector<int> SceneNumbers(const std::vector<Episode>& episodes) {
  std::map<std::string, int> numbers;
  std::vector<int> of_episode;
  for (const Episode& episode : episodes) {
    const auto next = static_cast<int>(numbers.size());
    of_episode.push_back(numbers.emplace(episode.scene_id, next).first->second);
  }
  return of_episode;
}

}  // namespace

Result<void> Evaluate(const Evaluation& evaluation, ResultWriter& writer) {
  const auto at = [&](int item) -> const Episode& {
    return evaluation.episodes[static_cast<std::size_t>(item)];
  };
  PoolTask task;
  task.count = static_cast<int>(evaluation.episodes.size());
  task.jobs = evaluation.jobs;
  task.item_seconds = evaluation.episode_seconds;
  task.groups = SceneNumbers(evaluation.episodes);
  task.work = [&](int item) -> Result<std::string> {
    const auto record = evaluation.play(at(item));
    if (!record) return tl::unexpected(record.error());
    return ToJsonLine(*record);
  };
  task.deliver = [&](int item, const ItemAnswer& answer) -> Result<void> {
    Result<EpisodeRecord> record =
        answer.end == ItemEnd::kDone
            ? EpisodeFromJsonLine(answer.text, at(item).episode_id)
            : Result<EpisodeRecord>(
                  FailedRecord(at(item), FailureOf(at(item), answer, evaluation.episode_seconds)));
    if (!record) return tl::unexpected(record.error());
    if (auto ok = writer.Append(*record); !ok) return ok;
    evaluation.finished(*record);
    return {};
  };
  return RunPool(task);
}

std::vector<Episode> GroupedByScene(std::vector<Episode> episodes) {
  const std::vector<int> scenes = SceneNumbers(episodes);
  std::multimap<int, std::size_t> order;
  for (std::size_t i = 0; i < episodes.size(); ++i) order.emplace(scenes[i], i);
  std::vector<Episode> grouped;
  grouped.reserve(episodes.size());
  for (const auto& [scene, i] : order) grouped.push_back(std::move(episodes[i]));
  return grouped;
}

std::vector<Episode> ShardOf(const std::vector<Episode>& episodes, int index, int count) {
  const auto all = static_cast<std::int64_t>(episodes.size());
  return {episodes.begin() + all * index / count, episodes.begin() + all * (index + 1) / count};
}

std::vector<Episode> Remaining(const std::vector<Episode>& episodes,
                               std::span<const EpisodeRecord> finished) {
  std::set<std::string> done;
  for (const EpisodeRecord& record : finished) done.insert(record.episode_id);
  std::vector<Episode> remaining;
  for (const Episode& episode : episodes) {
    if (done.count(episode.episode_id) == 0) remaining.push_back(episode);
  }
  return remaining;
}

}  // namespace crossnav::evaluation
