// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/pixel_cause.h"

#include <algorithm>

namespace crossnav::evaluation {
namespace {

constexpr double kSeenAll = 0.9;  // chosen: the rest are corners

bool Has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool WasOutOfReach(const StageCause& cause) {
  return Has(cause.last_ending, "unreachable") || Has(cause.last_ending, "no progress") ||
         Has(cause.last_ending, "no viewpoint");
}

}  // namespace

std::string_view PixelCauseOf(const StageRecord& stage) {
  if (stage.success) return {};
  if (stage.outcome == Outcome::kMisdetection) return "mistaken";
  if (stage.outcome == Outcome::kNotReached) return "mask";
  const StageCause cause = stage.extra.cause.value_or(StageCause{});
  if (Has(cause.last_ending, "refuted") || Has(cause.last_ending, "memory")) return "memory";
  if (stage.extra.passed_target) return "missed";
  if (cause.flight && cause.flight->floor != stage.floor_end)
    return cause.flight->seen ? "reach" : "stairs unseen";
  if (cause.seen_share >= kSeenAll) return "missed";
  return WasOutOfReach(cause) ? "reach" : "search";
}

std::vector<PixelCauseCount> CountPixelCauses(std::span<const EpisodeRecord> episodes) {
  std::vector<PixelCauseCount> counts;
  for (const EpisodeRecord& episode : episodes)
    for (const StageRecord& stage : episode.stages) {
      const std::string_view cause = PixelCauseOf(stage);
      if (cause.empty()) continue;
      auto it = std::find_if(counts.begin(), counts.end(), [&](const PixelCauseCount& count) {
        return count.goal == stage.goal;
      });
      if (it == counts.end()) it = counts.insert(it, PixelCauseCount{stage.goal, {}});
      const auto at = std::find(kPixelCauses.begin(), kPixelCauses.end(), cause);
      ++it->stages[static_cast<std::size_t>(at - kPixelCauses.begin())];
    }
  return counts;
}

}  // namespace crossnav::evaluation
