// SPDX-License-Identifier: MIT
// Writes the replay of an episode while it runs.
#pragma once

#include <filesystem>
#include <memory>

#include "crossnav/bench/result_records.h"
#include "crossnav/bench/runner.h"
#include "crossnav/trace/replay_writer.h"

namespace crossnav::app {

class ReplayLog : public bench::RunObserver {
 public:
  /// Creates missing folders. The replay is `<path>.part` until Close() gives it its name.
  static Result<std::unique_ptr<ReplayLog>> Open(const bench::SceneContext& context,
                                                 const bench::Episode& episode,
                                                 const bench::RunConfig& config,
                                                 const bench::RunHeader& header,
                                                 const std::filesystem::path& path);
  bool NeedsColour() const override { return true; }
  Result<void> OnStep(const bench::StepView& step) override;
  Result<void> OnStageEnd(const bench::StageRecord& stage) override;
  Result<void> Close() { return writer_.Close(); }

 private:
  explicit ReplayLog(trace::ReplayWriter writer) : writer_(std::move(writer)) {}
  trace::ReplayWriter writer_;
  int last_step_ = 0, goal_index_ = 0;
};

}  // namespace crossnav::app
