// SPDX-License-Identifier: MIT
#include "kept_replays.h"

#include "crossnav/bench/output_path.h"
#include "crossnav/bench/result_records.h"

namespace crossnav::app {

namespace fs = std::filesystem;

KeptReplays::KeptReplays(const EvalOptions& options, const bench::RunConfig& config,
                         const bench::RunHeader& header)
    : config_(config), header_(header) {
  if (options.keep_replays == "failures") folder_ = fs::path(options.out) / "replays";
}

Result<void> KeptReplays::Check() const {
  return bench::CheckOutputFolder(folder_, "--keep-replays");
}

Result<std::unique_ptr<ReplayLog>> KeptReplays::Open(const bench::SceneContext& context,
                                                     const bench::Episode& episode) const {
  if (folder_.empty()) return std::unique_ptr<ReplayLog>();
  return ReplayLog::Open(context, episode, config_, header_, PathOf(episode.episode_id));
}

void KeptReplays::Finish(const bench::EpisodeRecord& record) const {
  if (folder_.empty()) return;
  const fs::path path = PathOf(record.episode_id);
  fs::path unfinished = path;
  unfinished += ".part";
  std::error_code ignored;
  if (record.IsComplete()) {
    fs::remove(path, ignored);
    fs::remove(unfinished, ignored);
  } else if (record.failed && fs::exists(unfinished, ignored)) {
    fs::rename(unfinished, path, ignored);
  }
}

fs::path KeptReplays::PathOf(const std::string& episode_id) const {
  return folder_ / bench::ReplayName(episode_id);
}

}  // namespace crossnav::app
