// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "crossnav/evaluation/reporting/paper_numbers.h"
#include "crossnav/evaluation/reporting/report.h"
#include "crossnav/evaluation/scoring/cause.h"
#include "crossnav/evaluation/scoring/pixel_cause.h"

namespace crossnav::evaluation {
namespace {

const ReportFigure* Find(const std::vector<ReportFigure>& figures, const std::string& run,
                         const std::string& group, const std::string& metric) {
  for (const ReportFigure& f : figures) {
    if (f.run == run && f.group == group && f.metric == metric) return &f;
  }
  return nullptr;
}

/// "29.13 [26.1, 32.0]", or "-".
std::string Cell(const ReportFigure* figure) {
  if (figure == nullptr) return "-";
  std::string text = fmt::format("{:.2f}", 100 * figure->value);
  if (figure->interval) {
    text +=
        fmt::format(" [{:.1f}, {:.1f}]", 100 * figure->interval->low, 100 * figure->interval->high);
  }
  return text;
}

std::string Row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

std::string Head(const std::vector<std::string>& cells) {
  std::string rule = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) rule += i == 0 ? "---|" : "--:|";
  return Row(cells) + rule + "\n";
}

int GoalsOf(const std::vector<ReportRun>& runs) {
  std::size_t goals = 0;
  for (const ReportRun& run : runs) {
    for (const EpisodeRecord& episode : run.episodes) goals = std::max(goals, episode.goals.size());
  }
  return static_cast<int>(goals);
}

std::string NameOf(const ReportRun& run) {
  return run.name + (GroupByTrack(run.episodes).size() > 1 ? " (tracks pooled)" : "");
}

std::string SequenceTable(const std::vector<ReportRun>& runs,
                          const std::vector<ReportFigure>& figures, const std::string& group,
                          std::span<const PaperRow> paper) {
  std::string text = Head({"run", "episodes", "SR", "SPL", "PR", "PPL"});
  for (const ReportRun& run : runs) {
    const ReportFigure* sr = Find(figures, run.name, group, "SR");
    if (sr == nullptr) continue;
    text += Row({NameOf(run), std::to_string(sr->episodes), Cell(sr),
                 Cell(Find(figures, run.name, group, "SPL")),
                 Cell(Find(figures, run.name, group, "PR")),
                 Cell(Find(figures, run.name, group, "PPL"))});
  }
  for (const PaperRow& row : paper) {
    text += Row({fmt::format("*paper: {}*", row.method), group == "all" ? "927" : "288",
                 fmt::format("{:.2f}", row.sr), fmt::format("{:.2f}", row.spl),
                 fmt::format("{:.2f}", row.pr), fmt::format("{:.2f}", row.ppl)});
  }
  return text;
}

const std::array<double, 3>& ValuesOf(const PaperRow& row, const std::string& metric) {
  if (metric == "SR_cond") return row.sr_cond;
  if (metric == "SPL_cond") return row.spl_cond;
  return metric == "SR_global" ? row.sr_global : row.spl_global;
}

std::string StageTable(const std::vector<ReportRun>& runs, const std::vector<ReportFigure>& figures,
                       const std::string& group, const std::string& metric,
                       std::span<const PaperRow> paper) {
  const int goals = GoalsOf(runs);
  std::vector<std::string> head = {"run"};
  for (int k = 1; k <= goals; ++k) head.push_back(fmt::format("k={}", k));
  std::string text = Head(head);
  for (const ReportRun& run : runs) {
    std::vector<std::string> cells = {run.name};
    for (int k = 1; k <= goals; ++k) {
      cells.push_back(Cell(Find(figures, run.name, group, fmt::format("{}_{}", metric, k))));
    }
    text += Row(cells);
  }
  for (const PaperRow& row : paper) {
    const auto& values = ValuesOf(row, metric);
    std::vector<std::string> cells = {fmt::format("*paper: {}*", row.method)};
    for (int k = 0; k < goals; ++k) {
      cells.push_back(k < 3 ? fmt::format("{:.2f}", values[static_cast<std::size_t>(k)]) : "-");
    }
    text += Row(cells);
  }
  return text;
}

/// Each track of each run; no row pools tracks. Empty without tracks.
std::string TrackTable(const std::vector<ReportRun>& runs,
                       const std::vector<ReportFigure>& figures) {
  std::string rows;
  for (const ReportRun& run : runs) {
    for (const auto& [name, episodes] : GroupByTrack(run.episodes)) {
      const std::string group = "track:" + name;
      rows += Row({name, run.name, std::to_string(episodes.size()),
                   Cell(Find(figures, run.name, group, "SR")),
                   Cell(Find(figures, run.name, group + ":cfr", "SR")),
                   Cell(Find(figures, run.name, group, "SPL"))});
    }
  }
  if (rows.empty()) return rows;
  return Head({"track", "run", "episodes", "SR", "SR, floor change required", "SPL"}) + rows;
}

/// One line per group of a run; `groups` by name.
std::string GroupTable(const std::map<std::string, std::vector<EpisodeRecord>>& groups) {
  std::string text = Head({"group", "episodes", "SR", "SPL", "PR", "PPL"});
  for (const auto& [name, episodes] : groups) {
    const Metrics m = ComputeMetrics(episodes);
    text += Row({name, std::to_string(m.episodes), fmt::format("{:.2f}", 100 * m.sr),
                 fmt::format("{:.2f}", 100 * m.spl), fmt::format("{:.2f}", 100 * m.pr),
                 fmt::format("{:.2f}", 100 * m.ppl)});
  }
  return text;
}

std::string OutcomeTableText(const ReportRun& run) {
  std::vector<std::string> head = {"goal", "total"};
  for (const std::string_view name : kOutcomeNames) head.emplace_back(name);
  std::string text = Head(head);
  for (const auto& [goal, counts] : CountOutcomes(run.episodes)) {
    int total = 0;
    for (const int count : counts) total += count;
    std::vector<std::string> cells = {goal, std::to_string(total)};
    for (const int count : counts) cells.push_back(std::to_string(count));
    text += Row(cells);
  }
  for (const PaperOutcomes& p : PaperOutcomesOf(run.variant)) {
    text += Row({fmt::format("*paper: {}*", p.goal), std::to_string(p.total),
                 std::to_string(p.success), std::to_string(p.not_reached),
                 std::to_string(p.misdetection), std::to_string(p.all_explored),
                 std::to_string(p.stuck), std::to_string(p.out_of_time)});
  }
  return text;
}

/// Causes of failed stages; a line per cause, the most frequent first.
std::string CauseTableText(const ReportRun& run) {
  std::vector<std::string> head = {"cause", "stages"};
  for (std::size_t i = 1; i < kOutcomeNames.size(); ++i) head.emplace_back(kOutcomeNames[i]);
  head.emplace_back("walkable area seen, %");
  const auto counts = CountCauses(run.episodes);
  if (counts.empty()) return "No stage failed.\n";
  std::vector<std::pair<std::string, CauseCount>> rows(counts.begin(), counts.end());
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.second.stages > b.second.stages; });
  std::string text = Head(head);
  for (const auto& [cause, count] : rows) {
    std::vector<std::string> cells = {cause, std::to_string(count.stages)};
    for (std::size_t i = 1; i < count.outcomes.size(); ++i) {
      cells.push_back(std::to_string(count.outcomes[i]));
    }
    cells.push_back(fmt::format("{:.0f}", 100 * count.seen_share));
    text += Row(cells);
  }
  return text;
}

/// Causes of failures in runs from pixels.
std::string PixelCauseText(const ReportRun& run) {
  const auto counts = CountPixelCauses(run.episodes);
  if (run.perception.find("networks") == std::string::npos || counts.empty()) return {};
  std::vector<std::string> head = {"goal"};
  head.insert(head.end(), kPixelCauses.begin(), kPixelCauses.end());
  std::string text = "\n### Failures from pixels\n\n" + Head(head);
  for (const PixelCauseCount& count : counts) {
    std::vector<std::string> cells = {std::string(count.goal)};
    for (const int stages : count.stages) cells.push_back(std::to_string(stages));
    text += Row(cells);
  }
  return text;
}

std::string CategoryTableText(const ReportRun& run) {
  std::string text = Head({"goal", "executed", "SR", "SPL"});
  for (const auto& [name, category] : PerCategory(run.episodes)) {
    text += Row({name, std::to_string(category.executed), fmt::format("{:.2f}", 100 * category.sr),
                 fmt::format("{:.2f}", 100 * category.spl)});
  }
  return text;
}

/// By kind of goal; empty where all goals are categories.
std::string KindTableText(const ReportRun& run) {
  const auto kinds = PerKind(run.episodes);
  if (kinds.empty()) return {};
  std::string text = "\n### Kinds of goals\n\nOf the executed stages; Wilson 95 % intervals.\n\n" +
                     Head({"kind", "executed", "SR", "SPL"});
  for (const KindMetrics& kind : kinds) {
    const Interval interval = WilsonInterval(kind.successes, kind.executed);
    text += Row(
        {std::string(NameOf(kind.kind)), std::to_string(kind.executed),
         fmt::format("{:.2f} [{:.1f}, {:.1f}]", 100.0 * kind.successes / std::max(1, kind.executed),
                     100 * interval.low, 100 * interval.high),
         fmt::format("{:.2f}", 100 * kind.spl)});
  }
  return text;
}

/// Episodes of a run without a result; empty if there are none.
std::string FailedEpisodes(const ReportRun& run) {
  if (CountFailures(run.episodes).empty()) return {};
  std::string text = "\n### Failed episodes\n\nThey count as not successful.\n\n" +
                     Head({"episode", "reason", "message"});
  for (const EpisodeRecord& episode : run.episodes) {
    if (!episode.failed) continue;
    text += Row({episode.episode_id, episode.failed->reason, OneCell(episode.failed->message)});
  }
  return text;
}

/// tab:single_object_results
std::string SingleObjectSections(const std::vector<ReportRun>& runs,
                                 const std::vector<ReportFigure>& figures) {
  std::string text = "\n## Single-object navigation\n\n" +
                     Head({"method", "zero-shot", "multi-floor", "LLM", "episodes", "SR", "SPL"});
  for (const ReportRun& run : runs) {
    const ReportFigure* sr = Find(figures, run.name, "all", "SR");
    if (sr == nullptr) continue;
    text += Row({NameOf(run), "", "", "", std::to_string(sr->episodes), Cell(sr),
                 Cell(Find(figures, run.name, "all", "SPL"))});
  }
  const auto mark = [](bool holds) { return std::string(holds ? "yes" : "no"); };
  for (const PaperSingleRow& row : kPaperSingleObject) {
    text +=
        Row({fmt::format("*paper: {}*", row.method), mark(row.zero_shot), mark(row.multi_floor),
             mark(row.llm), "2000", fmt::format("{:.1f}", row.sr), fmt::format("{:.1f}", row.spl)});
  }
  return text;
}

/// The tables of a sequence of goals: tab:all_overall and its relatives.
std::string Sections(const std::vector<ReportRun>& runs, const std::vector<ReportFigure>& figures) {
  std::string text = "\n## All episodes\n\n" + SequenceTable(runs, figures, "all", kPaperAll);
  text += "\n## Episodes that require a floor change\n\n" +
          SequenceTable(runs, figures, "cfr", kPaperCrossFloor);
  const std::pair<const char*, const char*> metrics[] = {{"SR_cond", "Conditional SR"},
                                                         {"SPL_cond", "Conditional SPL"},
                                                         {"SR_global", "Global SR"},
                                                         {"SPL_global", "Global SPL"}};
  for (const auto& [metric, name] : metrics) {
    text += fmt::format("\n## {}, all episodes\n\n", name) +
            StageTable(runs, figures, "all", metric, kPaperAll);
    text += fmt::format("\n## {}, floor change required\n\n", name) +
            StageTable(runs, figures, "cfr", metric, kPaperCrossFloor);
  }
  return text;
}

std::string RunSection(const ReportRun& run) {
  return fmt::format("\n## {}\n\nvariant {}, {}, config {}, episodes {}\n", run.name,
                     run.variant.empty() ? "unknown" : run.variant,
                     run.perception.empty() ? "unknown perception" : run.perception,
                     run.config_hash, run.episodes_hash) +
         "\n### Floor requirement\n\n" + GroupTable(GroupByCrossFloor(run.episodes)) +
         "\n### Scenes\n\n" + GroupTable(GroupByScene(run.episodes)) + "\n### Categories\n\n" +
         CategoryTableText(run) + KindTableText(run) + "\n### Outcomes\n\n" +
         OutcomeTableText(run) + FailedEpisodes(run) + "\n### Causes of failure\n\n" +
         CauseTableText(run) + PixelCauseText(run);
}

}  // namespace

std::string OneCell(std::string text) {
  std::replace(text.begin(), text.end(), '|', '/');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string ReportMarkdown(const std::vector<ReportRun>& runs,
                           const std::vector<ReportFigure>& figures) {
  std::string text =
      "# Report\n\nPer cent, with bootstrap 95 % intervals over episodes. The paper's numbers were "
      "taken on HM3D with networks; they stand beside ours and are no target.\n";
  if (const std::string tracks = TrackTable(runs, figures); !tracks.empty())
    text += "\n## Tracks\n\nBy the origin of the buildings.\n\n" + tracks;
  text += GoalsOf(runs) == 1 ? SingleObjectSections(runs, figures) : Sections(runs, figures);
  for (const ReportRun& run : runs) text += RunSection(run);
  return text;
}

}  // namespace crossnav::evaluation
