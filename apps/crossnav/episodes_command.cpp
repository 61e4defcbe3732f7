// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/generation/described_goals.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/running/evaluation.h"
#include "eval_progress.h"
#include "scene_list.h"
#include "session.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

struct Tally {
  int episodes = 0, cross_floor = 0, alternating = 0;
  int goal_objects = 0, not_confirmable = 0;
  std::vector<int> first_stage;
};

Tally Count(const evaluation::EpisodeFile& file) {
  Tally tally;
  for (const evaluation::Episode& episode : file.episodes) {
    ++tally.episodes;
    tally.first_stage.resize(std::max(tally.first_stage.size(), episode.goals.size()));
    if (!episode.cross_floor_required) continue;
    ++tally.cross_floor;
    tally.alternating += evaluation::Alternates(episode) ? 1 : 0;
    ++tally.first_stage[static_cast<std::size_t>(episode.first_transition_stage - 1)];
  }
  for (const auto& [key, goals] : file.goals_by_category) {
    tally.goal_objects += static_cast<int>(goals.size());
    tally.not_confirmable += static_cast<int>(std::count_if(
        goals.begin(), goals.end(), [](const auto& goal) { return !goal.is_confirmable; }));
  }
  return tally;
}

Result<void> CheckWishes(const EpisodesOptions& options, const evaluation::RunConfig& config) {
  if (static_cast<int>(options.first.size()) > config.dataset.goals) {
    return Fail(ErrorCode::kInvalid, "names more stages than an episode has goals", "--first");
  }
  if (std::accumulate(options.first.begin(), options.first.end(), 0) > options.count) {
    return Fail(ErrorCode::kInvalid, "asks for more episodes than --count", "--first");
  }
  if (options.alternate > 0 && options.by_scene) {
    return Fail(ErrorCode::kInvalid, "is drawn over all scenes; leave out --by-scene",
                "--alternate");
  }
  return {};
}

Result<evaluation::EpisodeFile> Draw(const EpisodesOptions& options,
                                     const evaluation::RunConfig& config,
                                     const std::vector<std::string>& ids, Console& console) {
  CountProgress progress(console, "episodes drawn", static_cast<std::size_t>(options.count));
  evaluation::GeneratorOptions wishes{options.count, options.cross_floor, options.seed,
                                      options.first};
  wishes.alternating_share = options.alternate;
  wishes.drawn = [&](int done) { progress.Done(static_cast<std::size_t>(done)); };
  if (options.by_scene) {
    const auto load = [&](const std::string& id) {
      return evaluation::SceneContext::Load(options.scenes, id, config);
    };
    return evaluation::GenerateByScene(ids, load, config, wishes);
  }
  SceneCache cache(options.scenes, config);
  const auto scenes = cache.GetAll(ids, console);
  if (!scenes) return tl::unexpected(scenes.error());
  return evaluation::GenerateEpisodes(*scenes, config, wishes);
}

/// Goals in the form that was asked for; "mixed" has the three forms in equal parts.
Result<evaluation::MixedGoals> MixGoals(const EpisodesOptions& options,
                                        const evaluation::RunConfig& config,
                                        const std::vector<std::string>& ids,
                                        evaluation::EpisodeFile& file) {
  evaluation::MixedGoals count;
  if (options.goals_as == "category") return count;
  const evaluation::GoalMix mix = options.goals_as == "mixed"
                                      ? evaluation::GoalMix{1.0 / 3, 1.0 / 3}
                                  : options.goals_as == "picture" ? evaluation::GoalMix{0, 1}
                                                                  : evaluation::GoalMix{1, 0};
  for (const std::string& id : ids) {
    const auto context = evaluation::SceneContext::Load(options.scenes, id, config);
    if (!context) return tl::unexpected(context.error());
    const auto mixed = evaluation::MixGoals(**context, id, mix, options.seed, file);
    if (!mixed) return mixed;
    count.descriptions += mixed->descriptions;
    count.pictures += mixed->pictures;
  }
  return count;
}

/// Peak memory of this process.
double PeakMegabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

Result<void> EpisodesGenerate(const EpisodesOptions& options, const CommonOptions& common,
                              Console& console) {
  if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  if (options.goals > 0) config->dataset.goals = options.goals;
  if (options.repeats) config->dataset.allow_repeats = true;
  if (!options.certify.empty()) config->dataset.certificate = options.certify;
  if (auto ok = CheckWishes(options, *config); !ok) return ok;
  const auto scenes = options.scene_list.empty()
                          ? evaluation::ListScenes(options.scenes)
                          : ReadSceneList(options.scene_list, options.scenes);
  if (!scenes) return tl::unexpected(scenes.error());
  auto file = Draw(options, *config, *scenes, console);
  if (!file) return tl::unexpected(file.error());
  console.EndProgress();
  const auto mixed = MixGoals(options, *config, *scenes, *file);
  if (!mixed) return tl::unexpected(mixed.error());
  for (evaluation::Episode& episode : file->episodes) episode.track = options.track;
  if (auto ok = evaluation::WriteEpisodes(options.out, *file); !ok) return ok;
  const Tally tally = Count(*file);
  std::string stages;
  for (const int count : tally.first_stage)
    stages += fmt::format("{}{}", stages.empty() ? "" : "/", count);
  console.Print(
      fmt::format("{}: {} episodes in {} scenes, {} require a floor change (first at stage {})\n",
                  options.out, tally.episodes, scenes->size(), tally.cross_floor, stages));
  if (options.goals_as != "category")
    console.Print(fmt::format("  {} of their goals are descriptions, {} pictures\n",
                              mixed->descriptions, mixed->pictures));
  console.Log(fmt::format("peak memory {:.0f} MiB", PeakMegabytes()));
  if (file->certificate_edition > 1) {
    console.Print(fmt::format("  {} of {} goal objects are confirmed from nowhere\n",
                              tally.not_confirmable, tally.goal_objects));
  }
  if (options.alternate > 0) {
    console.Print(fmt::format("{} of them at every stage\n", tally.alternating));
  }
  console.Document(Json({{"file", options.out},
                         {"episodes", tally.episodes},
                         {"scenes", scenes->size()},
                         {"cross_floor_required", tally.cross_floor},
                         {"alternating", tally.alternating},
                         {"first_transition_stage", tally.first_stage},
                         {"certificate_edition", file->certificate_edition},
                         {"descriptions", mixed->descriptions},
                         {"pictures", mixed->pictures},
                         {"goal_objects", tally.goal_objects},
                         {"not_confirmable", tally.not_confirmable}}));
  return {};
}

Result<void> EpisodesCheck(const EpisodesOptions& options, const CommonOptions& common,
                           Console& console) {
  auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto file = evaluation::ReadEpisodes(options.file);
  if (!file) return tl::unexpected(file.error());
  config->dataset.certificate = file->certificate_edition > 1 ? "detection" : "coverage";
  SceneCache cache(options.scenes, *config);
  Json failures = Json::array();
  const auto fail = [&](const std::string& id, const std::string& problem) {
    console.Print(id + ": " + problem + "\n");
    failures.push_back({{"episode_id", id}, {"problem", problem}});
  };
  std::string scene_id;
  CountProgress progress(console, "episodes checked", file->episodes.size());
  std::size_t checked = 0;
  for (const evaluation::Episode& episode : evaluation::GroupedByScene(file->episodes)) {
    const auto context = cache.Get(episode.scene_id);
    std::vector<std::string> problems;
    if (context) {
      problems = evaluation::CheckCertificate(**context, episode, *config);
    } else {
      problems = {context.error().Message()};
    }
    if (context && file->certificate_edition > 1 && scene_id != episode.scene_id) {
      for (const std::string& problem :
           evaluation::CheckMarks(**context, episode.scene_id, file->goals_by_category))
        fail(evaluation::SceneName(episode.scene_id), problem);
    }
    scene_id = episode.scene_id;
    for (const std::string& problem : problems) fail(episode.episode_id, problem);
    progress.Done(++checked);
  }
  console.EndProgress();
  if (!failures.empty()) {
    // A single document: the list, without the error.
    if (console.json()) {
      return Fail(ErrorCode::kInvalid,
                  failures.dump(-1, ' ', false, Json::error_handler_t::replace), options.file);
    }
    return Fail(ErrorCode::kInvalid, fmt::format("{} claims do not hold", failures.size()),
                options.file);
  }
  console.Print(fmt::format("{}: all {} episodes hold\n", options.file, file->episodes.size()));
  console.Document(
      Json({{"file", options.file}, {"episodes", file->episodes.size()}, {"failures", failures}}));
  return {};
}

}  // namespace crossnav::app
