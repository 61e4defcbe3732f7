// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/running/survey.h"
#include "crossnav/world/house/embedded_house.h"
#include "play.h"
#include "watch_log.h"

namespace crossnav::app {
namespace {

/// Built-in episodes: starts and goals.
struct BuiltIn {
  int start_floor;
  std::vector<std::string> goals;
};

BuiltIn BuiltInEpisode(int number) {
  if (number == 1) return {0, {"sofa", "toilet", "bed"}};  // climbs
  return {1, {"bed", "tv_monitor", "chair"}};              // descends
}

}  // namespace

Result<void> Run(const RunOptions& options, const CommonOptions& common, Console& console) {
  const auto config = LoadRunConfig(
      common, {options.variant, options.success, options.budget_scope, options.perception});
  if (!config) return tl::unexpected(config.error());
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  const auto file = evaluation::ReadEpisodes(options.episodes);
  if (!file) return tl::unexpected(file.error());
  auto episode = FindEpisode(*file, options.episode, options.episodes);
  if (!episode) return tl::unexpected(episode.error());
  if (!options.memory.empty() &&
      evaluation::KnownOf(options.variant) != evaluation::Known::kNothing) {
    return Fail(ErrorCode::kInvalid, options.variant + " starts from a memory of its own",
                "--memory");
  }
  PlayFiles files;
  files.folder = options.out.empty() ? std::filesystem::path("out/run") / episode->episode_id
                                     : std::filesystem::path(options.out);
  files.replay = options.replay;
  files.map = options.save_map;
  files.memory = options.memory;
  files.is_pose_known = options.pose != "unknown";
  if (!files.is_pose_known && files.memory.empty())
    return Fail(ErrorCode::kInvalid, "a robot can only be lost in a map: give --memory", "--pose");
  if (auto ok = CheckOutputs(files); !ok) return ok;
  const auto watch = OpenWatch(options.watch, console);
  if (!watch) return tl::unexpected(watch.error());
  files.watch = watch->get();
  SceneCache cache(options.scenes, *config);
  cache.UseGoalsOf(*file);
  const auto context = cache.Get(episode->scene_id);
  if (!context) return tl::unexpected(context.error());
  if (auto ok = evaluation::CheckPlayable(**context, *episode); !ok) return ok;
  if (!episode->has_certificate) evaluation::Certify(**context, *episode);
  evaluation::RunHeader header = MakeHeader(*config, options.variant, *file);
  header.networks = perception->Hashes();
  header.scenes[evaluation::SceneName(episode->scene_id)] = HashesOf(**context);
  const auto record =
      PlayEpisode(**context, *episode, *config, header, files, *perception, console);
  if (!record) return tl::unexpected(record.error());
  return {};
}

Result<void> Demo(const DemoOptions& options, const CommonOptions& common, Console& console) {
  if (auto ok = evaluation::CheckOutputFolder(options.out, "--out"); !ok) return ok;
  Protocol protocol;
  protocol.perception = options.perception;
  const auto config = LoadRunConfig(common, protocol);
  if (!config) return tl::unexpected(config.error());
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  const auto watch = OpenWatch(options.watch, console);
  if (!watch) return tl::unexpected(watch.error());
  const std::filesystem::path out = options.out;
  const auto house = world::WriteEmbeddedHouse(out / "scenes");
  if (!house) return tl::unexpected(house.error());
  const auto ids = evaluation::ListScenes(out / "scenes");
  if (!ids) return tl::unexpected(ids.error());
  SceneCache cache(out / "scenes", *config);
  const auto context = cache.Get(ids->front());
  if (!context) return tl::unexpected(context.error());

  const evaluation::GeneratorScene scene{ids->front(), *context};
  const BuiltIn built_in = BuiltInEpisode(options.number);
  auto episode = evaluation::MakeEpisode(scene, *config, built_in.goals, built_in.start_floor,
                                         config->eval.seed);
  if (!episode) return tl::unexpected(episode.error());
  evaluation::EpisodeFile file;
  file.episodes = {*episode};
  evaluation::AddGoalObjects(scene, file);
  const auto path = out / fmt::format("episode_{}.json.gz", options.number);
  if (auto ok = evaluation::WriteEpisodes(path, file); !ok) return ok;
  const auto read = evaluation::ReadEpisodes(path);  // as any other run reads it
  if (!read) return tl::unexpected(read.error());

  evaluation::RunHeader header = MakeHeader(*config, "full", *read);
  header.networks = perception->Hashes();
  header.scenes[evaluation::SceneName(episode->scene_id)] = HashesOf(**context);
  const auto folder = out / fmt::format("{}", options.number);
  const PlayFiles files{folder,      folder / "replay.mcap", folder / "replay.html", {}, {},
                        watch->get()};
  const auto record =
      PlayEpisode(**context, read->episodes.front(), *config, header, files, *perception, console);
  if (!record) return tl::unexpected(record.error());
  if (record->Completed() == static_cast<int>(record->goals.size())) return {};
  return Fail(ErrorCode::kInvalid, "the built-in episode was not completed", folder.string());
}

}  // namespace crossnav::app
