// SPDX-License-Identifier: MIT
#include "kept_replays.h"

#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::app {

namespace fs = std::filesystem;

KeptReplays::KeptReplays(const EvalOptions& options, const evaluation::RunConfig& config,
                         const evaluation::RunHeader& header)
    : config_(config), header_(header) {
  if (options.keep_replays == "failures") folder_ = fs::path(options.out) / "replays";
}

Result<void> KeptReplays::Check() const {
  return evaluation::CheckOutputFolder(folder_, "--keep-replays");
}

Result<std::unique_ptr<ReplayLog>> KeptReplays::Open(const evaluation::SceneContext& context,
                                                     const evaluation::Episode& episode) const {
  if (folder_.empty()) return std::unique_ptr<ReplayLog>();
  return ReplayLog::Open(context, episode, config_, header_, PathOf(episode.episode_id));
}

void KeptReplays::Finish(const evaluation::EpisodeRecord& record) const {
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
  return folder_ / evaluation::ReplayName(episode_id);
}

}  // namespace crossnav::app
