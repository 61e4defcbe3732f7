// SPDX-License-Identifier: MIT
// A comparison as text and tables.
#include <fmt/format.h>

#include <algorithm>

#include "crossnav/evaluation/reporting/comparison.h"

namespace crossnav::evaluation {
namespace {

constexpr int kFlipsOnTerminal = 20;  // chosen: one screen; the report has all

struct TextLine {
  std::string name, difference, interval;
};

/// Shares in percentage points, lengths in metres.
std::vector<TextLine> Lines(const Comparison& c) {
  std::vector<TextLine> lines;
  for (const std::string& name : c.order) {
    const PairedDifference& d = c.differences.at(name);
    const double unit = name == "distance_to_goal_m" ? 1 : 100;
    lines.push_back(
        {name, fmt::format("{:+.2f}", unit * d.difference),
         fmt::format("[{:+.2f}, {:+.2f}]", unit * d.interval.low, unit * d.interval.high)});
  }
  return lines;
}

std::string HowResampled(const Comparison& c) {
  return c.scenes > 1 ? fmt::format("resampled by scene ({} scenes)", c.scenes)
                      : std::string("resampled by episode: there is one scene only");
}

std::string Joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

int Gained(const Comparison& c) {
  return static_cast<int>(std::count_if(c.flips.begin(), c.flips.end(), [](const Flip& flip) {
    return flip.after.goals > flip.before.goals;
  }));
}

std::string FlipSummary(const Comparison& c) {
  const int gained = Gained(c);
  return fmt::format("{} episodes flipped: {} completed now and not before, {} the other way",
                     c.flips.size(), gained, static_cast<int>(c.flips.size()) - gained);
}

std::string Words(const Ending& ending, int goals) {
  return fmt::format("{} ({}/{})", ending.outcome, ending.goals, goals);
}

/// The side that did not complete the episode.
const Ending& FailedSide(const Flip& flip) {
  return flip.after.goals > flip.before.goals ? flip.before : flip.after;
}

/// Relative to the folder of the report; a cell of a table.
std::string Link(const Ending& ending, const std::filesystem::path& folder) {
  if (ending.replay.empty()) return "-";
  // No resolution of links: the folder may not exist yet.
  const auto replay = std::filesystem::absolute(ending.replay).lexically_normal();
  const auto place = std::filesystem::absolute(folder).lexically_normal();
  return fmt::format("[replay](<{}>)", replay.lexically_proximate(place).generic_string());
}

}  // namespace

std::string ComparisonMarkdown(const Comparison& c, const std::filesystem::path& folder) {
  std::string text = fmt::format("\n## {} against {}, paired\n\n", c.name_b, c.name_a);
  if (!c.headers.unfair.empty()) {
    text += "**Forced: the runs differ in settings that they should share.** " +
            Joined(c.headers.unfair) + ".\n\n";
  }
  if (!c.headers.compared.empty()) text += "Compared: " + Joined(c.headers.compared) + ".\n\n";
  text += fmt::format("{} episodes in both; points of per cent; 95 % bootstrap, {}.\n\n",
                      c.episodes, HowResampled(c));
  text += "| metric | difference | 95 % |\n|---|--:|--:|\n";
  for (const TextLine& line : Lines(c)) {
    text += fmt::format("| {} | {} | {} |\n", line.name, line.difference, line.interval);
  }
  text += "\n" + FlipSummary(c) + ".\n";
  if (c.flips.empty()) return text;
  text += fmt::format("\n| episode | {} | {} | cause | replay |\n|---|---|---|---|---|\n", c.name_a,
                      c.name_b);
  for (const Flip& flip : c.flips) {
    const Ending& failed = FailedSide(flip);
    text +=
        fmt::format("| {} | {} | {} | {} | {} |\n", flip.episode_id, Words(flip.before, flip.goals),
                    Words(flip.after, flip.goals), OneCell(failed.cause), Link(failed, folder));
  }
  return text;
}

std::string ComparisonText(const Comparison& c) {
  std::string text = fmt::format("{} against {}: {} episodes, 95 % bootstrap, {}\n", c.name_b,
                                 c.name_a, c.episodes, HowResampled(c));
  if (!c.headers.unfair.empty()) {
    text += "  FORCED, the runs differ in: " + Joined(c.headers.unfair) + "\n";
  }
  if (!c.headers.compared.empty()) text += "  compared: " + Joined(c.headers.compared) + "\n";
  for (const TextLine& line : Lines(c)) {
    text += fmt::format("  {:<20} {:>8}  {}\n", line.name, line.difference, line.interval);
  }
  text += "  " + FlipSummary(c) + "\n";
  for (std::size_t i = 0; i < c.flips.size() && i < kFlipsOnTerminal; ++i) {
    const Flip& flip = c.flips[i];
    const Ending& failed = FailedSide(flip);
    text += fmt::format("    {}: {} -> {}: {}\n", flip.episode_id, Words(flip.before, flip.goals),
                        Words(flip.after, flip.goals), failed.cause);
  }
  if (c.flips.size() > kFlipsOnTerminal) {
    text += fmt::format("    and {} more, see report.md\n", c.flips.size() - kFlipsOnTerminal);
  }
  return text;
}

}  // namespace crossnav::evaluation
