// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "crossnav/evaluation/scoring/cause.h"

namespace crossnav::evaluation {
namespace {

/// "never seen", "seen, never begun", ...
std::string_view FlightWords(const FlightCause& flight) {
  if (flight.climbed) return "climbed";
  if (flight.begun) return "begun, never climbed";
  return flight.seen ? "seen, never begun" : "never seen";
}

std::string FlightText(const FlightCause& flight) {
  const std::string way =
      flight.floor == flight.goal_floor ? "" : fmt::format(" on the way to {}", flight.goal_floor);
  return fmt::format(" | flight to floor {}{} {}", flight.floor, way, FlightWords(flight));
}

/// "last go_to, ended: no progress" or "last climb, under way (before: go_to: unreachable)".
std::string ActivityText(const StageCause& cause) {
  if (cause.last_activity.empty()) return "no activity";
  const std::string own = cause.last_activity + ": ";
  if (!cause.is_under_way && cause.last_ending.starts_with(own)) {
    return fmt::format("last {}, ended: {}", cause.last_activity,
                       cause.last_ending.substr(own.size()));
  }
  return fmt::format("last {}, {}{}", cause.last_activity,
                     cause.is_under_way ? "under way" : "over",
                     cause.last_ending.empty() ? "" : " (before: " + cause.last_ending + ")");
}

/// Most steps first.
std::string StepsText(const StageCause& cause) {
  std::vector<std::pair<std::string, int>> steps(cause.steps.begin(), cause.steps.end());
  std::stable_sort(steps.begin(), steps.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text = "steps:";
  for (const auto& [name, count] : steps) text += fmt::format(" {} {}", name, count);
  return text;
}

std::string LineOf(const EpisodeRecord& episode, const StageRecord& stage) {
  const StageCause& cause = *stage.extra.cause;
  return fmt::format("{}: {} {} after {} | {}{} | {:.0f} % of the walkable area seen | {}",
                     episode.episode_id, stage.goal, NameOf(stage.outcome), stage.actions,
                     ActivityText(cause), cause.flight ? FlightText(*cause.flight) : "",
                     std::floor(100 * cause.seen_share), StepsText(cause));
}

}  // namespace

std::string CauseOf(const StageRecord& stage) {
  if (stage.success) return "";
  if (stage.outcome == Outcome::kMisdetection) return "stopped at the wrong object";
  if (stage.outcome == Outcome::kNotReached) return "stopped too far away";
  if (stage.extra.passed_target) return "passed the goal";
  if (!stage.extra.cause) return "unknown";
  const StageCause& cause = *stage.extra.cause;
  if (cause.flight && cause.flight->floor != stage.floor_end) {
    if (cause.flight->climbed) return "flight climbed and left again";
    return fmt::format("flight {}", FlightWords(*cause.flight));
  }
  if (cause.is_under_way) return cause.last_activity + " under way";
  return cause.last_ending.empty() ? "no activity" : cause.last_ending;
}

std::vector<std::string> CauseLines(const EpisodeRecord& episode) {
  std::vector<std::string> lines;
  for (const StageRecord& stage : episode.stages) {
    if (!stage.success && stage.extra.cause) lines.push_back(LineOf(episode, stage));
  }
  return lines;
}

std::map<std::string, CauseCount> CountCauses(std::span<const EpisodeRecord> episodes) {
  std::map<std::string, CauseCount> counts;
  for (const EpisodeRecord& episode : episodes) {
    for (const StageRecord& stage : episode.stages) {
      if (stage.success) continue;
      CauseCount& count = counts[CauseOf(stage)];
      ++count.stages;
      ++count.outcomes[static_cast<std::size_t>(stage.outcome)];
      const double share = stage.extra.cause ? stage.extra.cause->seen_share : 0;
      count.seen_share += (share - count.seen_share) / count.stages;
    }
  }
  return counts;
}

}  // namespace crossnav::evaluation
