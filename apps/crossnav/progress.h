// SPDX-License-Identifier: MIT
// Progress line of an episode: goal, mode, reason, steps per second, remaining steps.
#pragma once

#include "console.h"
#include "crossnav/evaluation/running/runner.h"

namespace crossnav::app {

class StepProgress : public evaluation::RunObserver {
 public:
  StepProgress(Console& console, const evaluation::Episode& episode,
               const evaluation::RunConfig& config);
  Result<void> OnStep(const evaluation::StepView& step) override;
  Result<void> OnStageEnd(const evaluation::StageRecord& stage) override;

 private:
  Console& console_;
  const evaluation::Episode& episode_;
  int budget_;
  double start_ms_;
  int steps_ = 0;
};

}  // namespace crossnav::app
