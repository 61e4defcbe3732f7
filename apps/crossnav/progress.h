// SPDX-License-Identifier: MIT
// The progress line of one episode: goal, mode, reason, steps per second, what remains.
#pragma once

#include "console.h"
#include "crossnav/bench/runner.h"

namespace crossnav::app {

class StepProgress : public bench::RunObserver {
 public:
  StepProgress(Console& console, const bench::Episode& episode, const bench::RunConfig& config);
  Result<void> OnStep(const bench::StepView& step) override;
  Result<void> OnStageEnd(const bench::StageRecord& stage) override;

 private:
  Console& console_;
  const bench::Episode& episode_;
  int budget_;
  double start_ms_;
  int steps_ = 0;
};

}  // namespace crossnav::app
