// SPDX-License-Identifier: MIT
// Shared code of `run`, `eval`, `demo` and `bench`: the episode file, its scenes and the run's
// header.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/store/map_file.h"

namespace crossnav::app {

/// --variant, --success, --budget-scope and --perception from the command line; empty = as
/// configured.
struct Protocol {
  std::string variant = "full", success, budget_scope, perception;
};
Result<evaluation::RunConfig> LoadRunConfig(const CommonOptions& common, const Protocol& protocol);

/// Cache of scenes, loaded on first use; keeps the last few.
class SceneCache {
 public:
  SceneCache(std::filesystem::path scenes_dir, const evaluation::RunConfig& config)
      : scenes_dir_(std::move(scenes_dir)), config_(config) {}

  /// Scenes take the viewpoints of an ObjectNav file; for other files viewpoints are computed, with
  /// the marks of a file of edition 2. `file` must outlive the cache.
  void UseGoalsOf(const evaluation::EpisodeFile& file) { file_ = &file; }

  Result<const evaluation::SceneContext*> Get(const std::string& scene_id);

  /// Loads these scenes and keeps them all, for drawing episodes.
  Result<std::vector<evaluation::GeneratorScene>> GetAll(const std::vector<std::string>& ids,
                                                         Console& console);

 private:
  struct Entry {
    std::string scene_id;
    std::unique_ptr<evaluation::SceneContext> context;
  };
  std::filesystem::path scenes_dir_;
  const evaluation::RunConfig& config_;
  std::size_t keep_ = 2;
  std::vector<Entry> entries_;  // oldest first
  const evaluation::EpisodeFile* file_ = nullptr;
};

/// Header of a run over `file`; `scenes` is filled in by the caller.
evaluation::RunHeader MakeHeader(const evaluation::RunConfig& config, const std::string& variant,
                                 const evaluation::EpisodeFile& file);

evaluation::SceneHashes HashesOf(const evaluation::SceneContext& context);

/// Features of different encoders are not comparable: fails unless the map is of `encoder`, or has
/// no features.
Result<void> CheckEncoder(const store::MapHeader& header, const std::string& encoder,
                          const std::string& path);

/// Episode `id` of the file.
Result<evaluation::Episode> FindEpisode(const evaluation::EpisodeFile& file, const std::string& id,
                                        const std::string& path);

}  // namespace crossnav::app
