// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/reporting/metrics_report.h"
#include "crossnav/evaluation/scoring/cause.h"
#include "eval_prepare.h"
#include "eval_progress.h"
#include "kept_replays.h"
#include "memory_files.h"
#include "perception_source.h"
#include "progress.h"

namespace crossnav::app {
namespace {

std::filesystem::path ResultPath(const std::string& out, const evaluation::Shard& shard) {
  const std::string name = shard.count == 1
                               ? std::string("results.jsonl")
                               : fmt::format("results.{}-of-{}.jsonl", shard.index, shard.count);
  return std::filesystem::path(out) / name;
}

struct RunSettings {
  const evaluation::RunConfig& config;
  const KeptReplays& replays;
  const PerceptionSource& perception;
  const KnownMemories& known;
};

/// Plays one episode in a worker.
Result<evaluation::EpisodeRecord> Play(SceneCache& cache, const evaluation::Episode& episode,
                                       const RunSettings& run, StepProgress* progress) {
  const auto context = cache.Get(episode.scene_id);
  if (!context) return tl::unexpected(context.error());
  std::vector<evaluation::RunObserver*> observers;
  if (progress != nullptr) observers.push_back(progress);
  const auto told = run.known.For(**context);
  if (!told) return tl::unexpected(told.error());
  if (*told) observers.push_back(told->get());
  auto replay = run.replays.Open(**context, episode);
  if (!replay) return tl::unexpected(replay.error());
  if (*replay) observers.push_back(replay->get());
  auto record =
      evaluation::RunEpisode(**context, episode, run.config, observers, run.perception.Maker());
  if (*replay) {
    const auto closed = (*replay)->Close();  // also for a failed episode
    if (record && !closed) return tl::unexpected(closed.error());
  }
  return record;
}

/// Plays the episodes that the file lacks.
Result<void> PlayAll(std::vector<evaluation::Episode> episodes, int jobs, SceneCache& cache,
                     const RunSettings& run, evaluation::ResultWriter& writer, Console& console) {
  EvalProgress shown(console, static_cast<int>(episodes.size()));
  evaluation::Evaluation evaluation;
  evaluation.episodes = std::move(episodes);
  evaluation.jobs = jobs;
  evaluation.episode_seconds = run.config.eval.episode_seconds;
  evaluation.play = [&](const evaluation::Episode& episode) {
    StepProgress progress(console, episode, run.config);
    auto record = Play(cache, episode, run, jobs == 1 ? &progress : nullptr);
    console.EndProgress();
    return record;
  };
  evaluation.finished = [&](const evaluation::EpisodeRecord& record) {
    run.replays.Finish(record);
    for (const std::string& line : evaluation::CauseLines(record)) console.Log(line);
    shown.Add(record);
  };
  return evaluation::Evaluate(evaluation, writer);
}

/// For a suite: the files must match its manifest.
Result<void> CheckHashes(const EvalOptions& options, const evaluation::RunHeader& header) {
  const char* remedy = "; these are not the suite's files: remove its folder and make it anew";
  if (!options.episodes_hash.empty() && header.episodes_hash != options.episodes_hash) {
    return Fail(ErrorCode::kMismatch,
                "hash is " + header.episodes_hash + ", not " + options.episodes_hash + remedy,
                options.episodes);
  }
  for (const auto& [scene, hashes] : header.scenes) {
    const auto wanted = options.mesh_hashes.find(scene);
    if (options.mesh_hashes.empty()) return {};
    if (wanted != options.mesh_hashes.end() && wanted->second == hashes.mesh_hash) continue;
    return Fail(ErrorCode::kMismatch,
                "mesh hash is " + hashes.mesh_hash + ", not " +
                    (wanted == options.mesh_hashes.end() ? "in the manifest" : wanted->second) +
                    remedy,
                options.scenes + ": " + scene);
  }
  return {};
}

}  // namespace

Result<void> Eval(const EvalOptions& options, const CommonOptions& common, Console& console) {
  const auto config = LoadRunConfig(
      common, {options.variant, options.success, options.budget_scope, options.perception});
  if (!config) return tl::unexpected(config.error());
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  const auto shard = evaluation::ParseShard(options.shard, "--shard");
  if (!shard) return tl::unexpected(shard.error());
  const auto path = ResultPath(options.out, *shard);
  if (auto ok = evaluation::CheckOutputFile(path, "--out"); !ok) return ok;
  const auto file = evaluation::ReadEpisodes(options.episodes);
  if (!file) return tl::unexpected(file.error());
  auto episodes =
      evaluation::ShardOf(evaluation::GroupedByScene(file->episodes), shard->index, shard->count);
  evaluation::RunHeader header = MakeHeader(*config, options.variant, *file);
  header.shard = options.shard;
  header.networks = perception->Hashes();
  const KeptReplays replays(options, *config, header);
  if (auto ok = replays.Check(); !ok) return ok;
  SceneCache cache(options.scenes, *config);
  cache.UseGoalsOf(*file);
  if (auto ok = PrepareEval(cache, options.jobs, episodes, header, console); !ok) return ok;
  if (auto ok = CheckHashes(options, header); !ok) return ok;

  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), options.out);
  std::vector<evaluation::EpisodeRecord> finished;
  auto writer = evaluation::ResultWriter::Open(path, header, finished);
  if (!writer) return tl::unexpected(writer.error());
  auto remaining = evaluation::Remaining(episodes, finished);
  if (!finished.empty()) {
    console.Log(fmt::format("{}: {} episodes are there, {} remain", path.string(), finished.size(),
                            remaining.size()));
  }
  const KnownMemories known(std::filesystem::path(options.out) / "known", options.variant, *config,
                            perception->EncoderName());
  if (auto ok = PlayAll(std::move(remaining), options.jobs, cache,
                        {*config, replays, *perception, known}, *writer, console);
      !ok) {
    return ok;
  }
  const auto results = evaluation::ReadResults(path);
  if (!results) return tl::unexpected(results.error());
  console.Print(evaluation::MetricsText(results->episodes, {}) + path.string() + "\n");
  if (console.json()) console.Document(evaluation::MetricsJson(results->episodes, {}));
  return {};
}

}  // namespace crossnav::app
