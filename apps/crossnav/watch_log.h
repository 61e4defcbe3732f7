// SPDX-License-Identifier: MIT
// `--watch`: shows an episode, or a robot's session, live in the browser.
#pragma once

#include <memory>

#include "commands.h"
#include "crossnav/agent/graph_watch.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/watch/watch.h"

namespace crossnav::app {

/// Null without `--watch`. Prints the page's address. Error: the port is taken.
Result<std::unique_ptr<watch::Watch>> OpenWatch(const WatchOptions& options, Console& console);

/// Forwards steps to viewers. A failing watch (a full disk) is reported once and then ignored; the
/// run continues.
class WatchFeed {
 public:
  /// `watch` may be null.
  WatchFeed(watch::Watch* watch, Console& console) : watch_(watch), console_(console) {}

  void Start(const trace::ReplayInfo& info, const agent::Agent& agent);
  void Add(const Observation& obs, const trace::StepTrace& trace,
           const perception::Percept& percept, const agent::Agent& agent);
  void AddStage(const trace::StageResult& stage);
  /// Gives viewers a few seconds to receive the remaining events.
  void Close();

 private:
  void Check(const Result<void>& done);

  watch::Watch* watch_;
  Console& console_;
  agent::GraphWatch graph_;
};

/// WatchFeed of a running episode.
class WatchLog : public evaluation::RunObserver {
 public:
  WatchLog(trace::ReplayInfo info, watch::Watch* watch, Console& console)
      : info_(std::move(info)), feed_(watch, console) {}
  bool NeedsColour() const override { return true; }
  Result<void> OnStart(agent::Agent& state) override;
  Result<void> OnStep(const evaluation::StepView& step) override;
  Result<void> OnStageEnd(const evaluation::StageRecord& stage) override;
  void Close() { feed_.Close(); }

 private:
  trace::ReplayInfo info_;
  WatchFeed feed_;
  int last_step_ = 0, goal_index_ = 0;
};

}  // namespace crossnav::app
