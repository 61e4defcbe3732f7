// SPDX-License-Identifier: MIT
#include "eval_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "crossnav/evaluation/running/timing.h"

namespace crossnav::app {

EvalProgress::EvalProgress(Console& console, int episodes)
    : console_(console), episodes_(episodes), start_ms_(evaluation::WallMs()) {}

void EvalProgress::Add(const evaluation::EpisodeRecord& record) {
  ++done_;
  ++outcomes_[std::string(record.OutcomeName())];
  if (record.failed) {
    console_.Log(fmt::format("{}: failed ({}): {}", record.episode_id, record.failed->reason,
                             record.failed->message));
  }
  const double seconds = std::max(1e-3, (evaluation::WallMs() - start_ms_) * 1e-3);
  std::string outcomes;
  for (const auto& [name, count] : outcomes_) {
    outcomes += fmt::format("{}{} {}", outcomes.empty() ? "" : ", ", name, count);
  }
  console_.Progress(fmt::format("{} of {} episodes | {} | {:.1f} per hour | {} left", done_,
                                episodes_, outcomes, done_ / seconds * 3600,
                                DurationText(seconds / done_ * (episodes_ - done_))));
}

CountProgress::CountProgress(Console& console, std::string things, std::size_t total)
    : console_(console),
      things_(std::move(things)),
      total_(total),
      start_ms_(evaluation::WallMs()) {}

void CountProgress::Done(std::size_t count) {
  const double seconds = std::max(1e-3, (evaluation::WallMs() - start_ms_) * 1e-3);
  const double per_s = static_cast<double>(count) / seconds;
  const double left_s = static_cast<double>(total_ - count) / std::max(1e-9, per_s);
  console_.Progress(fmt::format("{} of {} {} | {:.1f} per s | {} left", count, total_, things_,
                                per_s, DurationText(left_s)));
}

std::string DurationText(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace crossnav::app
