// SPDX-License-Identifier: MIT
// `demo`: episodes in the house that comes with the program; `demo lifelong`: day one, a night that
// carries the goal upstairs, day two with the memory of day one.
#include <fmt/format.h>

#include "change_text.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/world/change/house_days.h"
#include "crossnav/world/house/embedded_house.h"
#include "play.h"
#include "watch_log.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;

/// Settings of a demo, shared by its episodes.
struct Demonstration {
  fs::path out;
  const evaluation::RunConfig& config;
  const PerceptionSource& perception;
  watch::Watch* watch;
  Console& console;
};

/// Built-in episode.
struct BuiltIn {
  std::string name;  ///< of its folder
  int start_floor = 0;
  std::vector<std::string> goals;
};

BuiltIn BuiltInEpisode(const std::string& name) {
  if (name == "1") return {name, 0, {"sofa", "toilet", "bed"}};  // climbs
  return {name, 1, {"bed", "tv_monitor", "chair"}};              // descends
}

/// Draws the episode, writes its file, and plays the file as any other run does. `files`: the map
/// to start from and to save. Error: a goal was not found.
Result<void> Play(const Demonstration& demo, const std::string& scene_id, const BuiltIn& built_in,
                  PlayFiles files) {
  SceneCache cache(demo.out / "scenes", demo.config);
  const auto context = cache.Get(scene_id);
  if (!context) return tl::unexpected(context.error());
  const evaluation::GeneratorScene scene{scene_id, *context};
  auto episode = evaluation::MakeEpisode(scene, demo.config, built_in.goals, built_in.start_floor,
                                         demo.config.eval.seed);
  if (!episode) return tl::unexpected(episode.error());
  evaluation::EpisodeFile file;
  file.episodes = {*episode};
  evaluation::AddGoalObjects(scene, file);
  const auto path = demo.out / fmt::format("episode_{}.json.gz", built_in.name);
  if (auto ok = evaluation::WriteEpisodes(path, file); !ok) return ok;
  const auto read = evaluation::ReadEpisodes(path);
  if (!read) return tl::unexpected(read.error());
  evaluation::RunHeader header = MakeHeader(demo.config, "full", *read);
  header.networks = demo.perception.Hashes();
  header.scenes[evaluation::SceneName(scene_id)] = HashesOf(**context);
  files.folder = demo.out / built_in.name;
  files.replay = files.folder / "replay.mcap";
  files.page = files.folder / "replay.html";
  files.watch = demo.watch;
  const auto record = PlayEpisode(**context, read->episodes.front(), demo.config, header, files,
                                  demo.perception, demo.console);
  if (!record) return tl::unexpected(record.error());
  if (record->Completed() == static_cast<int>(record->goals.size())) return {};
  return Fail(ErrorCode::kInvalid, "the built-in episode was not completed", files.folder.string());
}

/// A night that carries the only sofa of the embedded house upstairs.
Result<world::DayReport> NightOf(const fs::path& house) {
  world::DaysOptions options;
  options.seed = 2;  // chosen: the first seed that draws the sofa
  options.kinds = {world::ChangeKind::kOtherFloor};
  auto days = world::WriteDays(house, {}, options);
  if (!days) return tl::unexpected(days.error());
  if (days->front().list.changes.empty())
    return Fail(ErrorCode::kInvalid, "no object has a place on the other floor", house.string());
  return std::move(days->front());
}

/// `day_one`: the demonstration with a console that leaves --json's one document to day two.
Result<void> PlayLifelong(const Demonstration& day_one, const Demonstration& demo,
                          const fs::path& house) {
  const auto night = NightOf(house);
  if (!night) return tl::unexpected(night.error());
  const world::Change& change = night->list.changes.front();
  PlayFiles files;
  files.map = demo.out / "home.map";
  std::error_code ignored;
  fs::remove(files.map, ignored);  // of an earlier demo: its days would count
  demo.console.Print("day one\n");
  const BuiltIn before = {"day1", 0, {change.category, "bed"}};
  if (auto ok = Play(day_one, world::kEmbeddedSceneId, before, files); !ok) return ok;
  demo.console.Print("night\n" + ChangeText(change) + "day two\n");
  files.memory = files.map;
  const BuiltIn after = {"day2", 0, {change.category}};
  return Play(demo, night->list.scene, after, files);
}

}  // namespace

Result<void> Demo(const DemoOptions& options, const CommonOptions& common, Console& console) {
  if (auto ok = evaluation::CheckOutputFolder(options.out, "--out"); !ok) return ok;
  const bool is_lifelong = options.name == "lifelong";
  CommonOptions all = common;
  if (is_lifelong) all.overrides.insert(all.overrides.begin(), "memory.mode=revise");
  Protocol protocol;
  protocol.perception = options.perception;
  const auto config = LoadRunConfig(all, protocol);
  if (!config) return tl::unexpected(config.error());
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  const auto watch = OpenWatch(options.watch, console);
  if (!watch) return tl::unexpected(watch.error());
  const fs::path out = is_lifelong ? fs::path(options.out) / "lifelong" : fs::path(options.out);
  const auto house = world::WriteEmbeddedHouse(out / "scenes");
  if (!house) return tl::unexpected(house.error());
  const Demonstration demo{out, *config, *perception, watch->get(), console};
  if (is_lifelong) {
    Console silent(common.json, common.quiet, /*is_silent=*/common.json);
    return PlayLifelong({out, *config, *perception, watch->get(), silent}, demo, *house);
  }
  const auto ids = evaluation::ListScenes(out / "scenes");
  if (!ids) return tl::unexpected(ids.error());
  return Play(demo, ids->front(), BuiltInEpisode(options.name), {});
}

}  // namespace crossnav::app
