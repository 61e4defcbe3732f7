// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "crossnav/bench/cause.h"
#include "crossnav/bench/metrics_report.h"
#include "crossnav/bench/runner.h"
#include "crossnav/bench/timing.h"
#include "crossnav/bench/worker_pool.h"
#include "progress.h"
#include "session.h"

namespace crossnav::app {
namespace {

struct Shard {
  int index = 0, count = 1;
};

Result<Shard> ParseShard(const std::string& text) {
  Shard shard;
  char rest = 0;
  const int parts = std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest);
  if (parts != 2 || shard.count < 1 || shard.index < 0 || shard.index >= shard.count) {
    return Fail(ErrorCode::kInvalid, "\"" + text + "\" is not I/N with 0 <= I < N", "--shard");
  }
  return shard;
}

/// The shard's own episodes: neighbours stay together, so that few scenes are loaded.
std::vector<bench::Episode> EpisodesOf(const bench::EpisodeFile& file, const Shard& shard) {
  const auto all = static_cast<std::int64_t>(file.episodes.size());
  const std::int64_t begin = all * shard.index / shard.count;
  const std::int64_t end = all * (shard.index + 1) / shard.count;
  return {file.episodes.begin() + begin, file.episodes.begin() + end};
}

/// Checks the scene's episodes against it; its hashes, separated by a blank.
Result<std::string> CheckScene(SceneCache& cache, const std::string& scene_id,
                               const std::vector<bench::Episode>& episodes) {
  const auto context = cache.Get(scene_id);
  for (const bench::Episode& episode : episodes) {
    if (episode.scene_id != scene_id) continue;
    if (!context) {
      Error error = context.error();
      error.what = episode.where + ": scene_id: " + error.what;
      return tl::unexpected(error);
    }
    if (auto ok = bench::CheckPlayable(**context, episode); !ok) return tl::unexpected(ok.error());
  }
  const bench::SceneHashes hashes = HashesOf(**context);
  return hashes.mesh_hash + " " + hashes.navmesh_hash;
}

/// Checks every episode before anything is written, and notes the scenes' hashes. Scenes are loaded
/// by the workers alone: a process with the ray caster's threads must not be forked.
Result<void> Prepare(SceneCache& cache, const std::vector<bench::Episode>& episodes, int jobs,
                     bench::RunHeader& header, Console& console) {
  std::vector<std::string> scenes;
  for (const bench::Episode& episode : episodes) {
    const bool is_known = std::find(scenes.begin(), scenes.end(), episode.scene_id) != scenes.end();
    if (!is_known) scenes.push_back(episode.scene_id);
  }
  int done = 0;
  bench::PoolTask task;
  task.count = static_cast<int>(scenes.size());
  task.jobs = jobs;
  task.work = [&](int item) {
    return CheckScene(cache, scenes[static_cast<std::size_t>(item)], episodes);
  };
  task.deliver = [&](int item, const std::string& hashes) -> Result<void> {
    const std::size_t blank = hashes.find(' ');
    header.scenes[bench::SceneName(scenes[static_cast<std::size_t>(item)])] = {
        hashes.substr(0, blank), hashes.substr(blank + 1)};
    return {};
  };
  task.arrived = [&](int) {
    console.Progress(fmt::format("checked scene {} of {}", ++done, scenes.size()));
  };
  return bench::RunPool(task);
}

std::filesystem::path ResultPath(const std::string& out, const Shard& shard) {
  const std::string name = shard.count == 1
                               ? std::string("results.jsonl")
                               : fmt::format("results.{}-of-{}.jsonl", shard.index, shard.count);
  return std::filesystem::path(out) / name;
}

/// Episodes that are not in the result file yet.
std::vector<bench::Episode> Remaining(const std::vector<bench::Episode>& episodes,
                                      const std::vector<bench::EpisodeRecord>& finished) {
  std::set<std::string> done;
  for (const bench::EpisodeRecord& record : finished) done.insert(record.episode_id);
  std::vector<bench::Episode> remaining;
  for (const bench::Episode& episode : episodes) {
    if (done.count(episode.episode_id) == 0) remaining.push_back(episode);
  }
  return remaining;
}

class Evaluation {
 public:
  Evaluation(SceneCache& cache, const bench::RunConfig& config,
             const std::vector<bench::Episode>& episodes, Console& console)
      : cache_(cache), config_(config), episodes_(episodes), console_(console) {}

  Result<void> Run(int jobs, bench::ResultWriter& writer) {
    bench::PoolTask task;
    task.count = static_cast<int>(episodes_.size());
    task.jobs = jobs;
    task.work = [&](int item) {
      return Play(episodes_[static_cast<std::size_t>(item)], jobs == 1);
    };
    task.deliver = [&](int, const std::string& text) {
      const std::size_t end = text.find('\n');
      if (end != std::string::npos) console_.Log(text.substr(end + 1));
      return writer.AppendLine(text.substr(0, end));
    };
    task.arrived = [&](int) { ShowProgress(); };
    return bench::RunPool(task);
  }

 private:
  /// The record, and in further lines why stages failed.
  Result<std::string> Play(const bench::Episode& episode, bool is_alone) {
    const auto context = cache_.Get(episode.scene_id);
    if (!context) return tl::unexpected(context.error());
    bench::Episode certified = episode;
    if (!certified.has_certificate) bench::Certify(**context, certified);
    StepProgress progress(console_, certified, config_);
    std::vector<bench::RunObserver*> observers;
    if (is_alone) observers.push_back(&progress);
    const auto record = bench::RunEpisode(**context, certified, config_, observers);
    if (!record) {
      Error error = record.error();
      error.where = episode.episode_id + (error.where.empty() ? "" : ": " + error.where);
      return tl::unexpected(error);
    }
    std::string text = bench::ToJsonLine(*record);
    for (const std::string& line : bench::CauseLines(*record)) text += "\n" + line;
    return text;
  }

  void ShowProgress() {
    ++done_;
    const double seconds = (bench::WallMs() - start_ms_) * 1e-3;
    const double left_s = seconds / done_ * (static_cast<double>(episodes_.size()) - done_);
    console_.Progress(fmt::format("{} of {} episodes | {:.1f} per hour | {:.0f} s left", done_,
                                  episodes_.size(), done_ / seconds * 3600, left_s));
  }

  SceneCache& cache_;
  const bench::RunConfig& config_;
  const std::vector<bench::Episode>& episodes_;
  Console& console_;
  double start_ms_ = bench::WallMs();
  int done_ = 0;
};

}  // namespace

Result<void> Eval(const EvalOptions& options, const CommonOptions& common, Console& console) {
  const auto config =
      LoadRunConfig(common, {options.variant, options.success, options.budget_scope});
  if (!config) return tl::unexpected(config.error());
  const auto shard = ParseShard(options.shard);
  if (!shard) return tl::unexpected(shard.error());
  const auto file = bench::ReadEpisodes(options.episodes);
  if (!file) return tl::unexpected(file.error());
  const auto episodes = EpisodesOf(*file, *shard);
  bench::RunHeader header = MakeHeader(*config, options.variant, *file);
  header.shard = options.shard;
  SceneCache cache(options.scenes, *config);
  if (auto ok = Prepare(cache, episodes, options.jobs, header, console); !ok) return ok;

  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), options.out);
  const auto path = ResultPath(options.out, *shard);
  std::vector<bench::EpisodeRecord> finished;
  auto writer = bench::ResultWriter::Open(path, header, finished);
  if (!writer) return tl::unexpected(writer.error());
  const auto remaining = Remaining(episodes, finished);
  if (!finished.empty()) {
    console.Log(fmt::format("{}: {} episodes are there, {} remain", path.string(), finished.size(),
                            remaining.size()));
  }
  if (auto ok = Evaluation(cache, *config, remaining, console).Run(options.jobs, *writer); !ok) {
    return ok;
  }
  const auto results = bench::ReadResults(path);
  if (!results) return tl::unexpected(results.error());
  console.Print(bench::MetricsText(results->episodes, {}) + path.string() + "\n");
  if (console.json()) console.Document(bench::MetricsJson(results->episodes, {}));
  return {};
}

}  // namespace crossnav::app
