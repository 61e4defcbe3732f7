// SPDX-License-Identifier: MIT
// `eval --keep-replays failures`: every episode is recorded while it runs, and the replays of those
// that did not complete stay, as RUN/replays/<episode>.mcap.
#pragma once

#include <filesystem>
#include <memory>

#include "commands.h"
#include "replay_log.h"

namespace crossnav::app {

class KeptReplays {
 public:
  KeptReplays(const EvalOptions& options, const evaluation::RunConfig& config,
              const evaluation::RunHeader& header);

  /// Whether replays can be written; nothing to check where none is kept.
  Result<void> Check() const;
  /// In a worker, before the episode; null where none is kept.
  Result<std::unique_ptr<ReplayLog>> Open(const evaluation::SceneContext& context,
                                          const evaluation::Episode& episode) const;
  /// In the program, when the episode has its record: keeps or removes the replay. Of a worker that
  /// crashed or was killed it keeps what has reached the disk.
  void Finish(const evaluation::EpisodeRecord& record) const;

 private:
  std::filesystem::path PathOf(const std::string& episode_id) const;

  std::filesystem::path folder_;  // empty = none is kept
  const evaluation::RunConfig& config_;
  const evaluation::RunHeader& header_;
};

}  // namespace crossnav::app
