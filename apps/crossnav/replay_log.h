// SPDX-License-Identifier: MIT
// Writes the replay of an episode during its run.
#pragma once

#include <filesystem>
#include <memory>

#include "crossnav/agent/graph_watch.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/trace/replay_writer.h"

namespace crossnav::app {

/// Head of a replay; ground truth of the goals is for display.
trace::ReplayInfo ReplayInfoOf(const evaluation::SceneContext& context,
                               const evaluation::Episode& episode,
                               const evaluation::RunConfig& config,
                               const evaluation::RunHeader& header);

trace::StageResult StageResultOf(const evaluation::StageRecord& stage, int goal_index,
                                 int last_step);

class ReplayLog : public evaluation::RunObserver {
 public:
  /// Creates missing folders. The replay is `<path>.part` until Close() renames it.
  static Result<std::unique_ptr<ReplayLog>> Open(const evaluation::SceneContext& context,
                                                 const evaluation::Episode& episode,
                                                 const evaluation::RunConfig& config,
                                                 const evaluation::RunHeader& header,
                                                 const std::filesystem::path& path);
  bool NeedsColour() const override { return true; }
  Result<void> OnStep(const evaluation::StepView& step) override;
  Result<void> OnStageEnd(const evaluation::StageRecord& stage) override;
  Result<void> Close() { return writer_.Close(); }

 private:
  explicit ReplayLog(trace::ReplayWriter writer) : writer_(std::move(writer)) {}
  trace::ReplayWriter writer_;
  agent::GraphWatch graph_;
  bool is_first_ = true;
  int last_step_ = 0, goal_index_ = 0;
};

}  // namespace crossnav::app
