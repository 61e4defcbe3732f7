// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/running/survey.h"
#include "play.h"
#include "watch_log.h"

namespace crossnav::app {

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

}  // namespace crossnav::app
