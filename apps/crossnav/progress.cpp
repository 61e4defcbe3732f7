// SPDX-License-Identifier: MIT
#include "progress.h"

#include <fmt/format.h>

#include <algorithm>

#include "crossnav/evaluation/running/timing.h"

namespace crossnav::app {

StepProgress::StepProgress(Console& console, const evaluation::Episode& episode,
                           const evaluation::RunConfig& config)
    : console_(console),
      episode_(episode),
      budget_(config.eval.action_budget),
      start_ms_(evaluation::WallMs()) {}

Result<void> StepProgress::OnStep(const evaluation::StepView& step) {
  ++steps_;
  const double seconds = std::max(1e-3, (evaluation::WallMs() - start_ms_) * 1e-3);
  const double rate = steps_ / seconds;
  const int left = std::max(0, budget_ - steps_);
  console_.Progress(
      fmt::format("goal {}/{} {} | {} ({}) | {:.1f} steps/s | {} steps, {:.0f} s left",
                  step.trace.goal_index + 1, episode_.goals.size(), step.trace.goal,
                  step.trace.mode, step.trace.reason, rate, left, left / rate));
  return {};
}

Result<void> StepProgress::OnStageEnd(const evaluation::StageRecord& stage) {
  console_.Log(fmt::format("{}: {} after {} actions, {:.2f} m (shortest {:.2f} m)", stage.goal,
                           evaluation::NameOf(stage.outcome), stage.actions, stage.length_m,
                           stage.shortest_m));
  return {};
}

}  // namespace crossnav::app
