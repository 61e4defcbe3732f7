// SPDX-License-Identifier: MIT
// `eval --keep-replays failures`: every episode is recorded during its run, and the replays of
// failed episodes are kept, as RUN/replays/<episode>.mcap.
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

  /// Checks that replays can be written; no check if none are kept.
  Result<void> Check() const;
  /// In a worker, before the episode; null if none are kept.
  Result<std::unique_ptr<ReplayLog>> Open(const evaluation::SceneContext& context,
                                          const evaluation::Episode& episode) const;
  /// In the program, after the episode's record: keeps or removes the replay. Of a crashed or
  /// killed worker it keeps the part on disk.
  void Finish(const evaluation::EpisodeRecord& record) const;

 private:
  std::filesystem::path PathOf(const std::string& episode_id) const;

  std::filesystem::path folder_;  // empty = none is kept
  const evaluation::RunConfig& config_;
  const evaluation::RunHeader& header_;
};

}  // namespace crossnav::app
