// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "crossnav/evaluation/reporting/paper_numbers.h"
#include "crossnav/evaluation/reporting/report.h"
#include "crossnav/evaluation/scoring/cause.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;

/// The figure `metric` of a row of the paper's table, as a share.
std::optional<double> ValueOf(const PaperRow& row, const std::string& metric) {
  if (metric == "SR") return row.sr / 100;
  if (metric == "SPL") return row.spl / 100;
  if (metric == "PR") return row.pr / 100;
  if (metric == "PPL") return row.ppl / 100;
  for (std::size_t k = 0; k < 3; ++k) {
    if (metric == fmt::format("SR_cond_{}", k + 1)) return row.sr_cond[k] / 100;
    if (metric == fmt::format("SPL_cond_{}", k + 1)) return row.spl_cond[k] / 100;
    if (metric == fmt::format("SR_global_{}", k + 1)) return row.sr_global[k] / 100;
    if (metric == fmt::format("SPL_global_{}", k + 1)) return row.spl_global[k] / 100;
  }
  return std::nullopt;
}

/// The paper's value of a figure of episodes with one goal.
std::optional<double> SingleValue(const std::string& variant, const std::string& group,
                                  const std::string& metric) {
  if (group != "all" || variant.empty()) return std::nullopt;
  for (const PaperSingleRow& row : kPaperSingleObject) {
    if (row.variant != variant) continue;
    if (metric == "SR") return row.sr / 100;
    if (metric == "SPL") return row.spl / 100;
  }
  return std::nullopt;
}

/// The paper's value of a figure for this variant, for episodes with three goals or one.
std::optional<double> PaperValue(const std::string& variant, const std::string& group, int goals,
                                 const std::string& metric) {
  if (goals == 1) return SingleValue(variant, group, metric);
  if (group != "all" && group != "cfr") return std::nullopt;
  for (const PaperRow& row : group == "all" ? kPaperAll : kPaperCrossFloor)
    if (row.variant == variant) return ValueOf(row, metric);
  return std::nullopt;
}

void AddGroup(const ReportRun& run, const std::string& group,
              const std::vector<EpisodeRecord>& episodes, const BootstrapConfig& bootstrap,
              std::vector<ReportFigure>& figures) {
  const Metrics metrics = ComputeMetrics(episodes);
  const auto intervals = BootstrapIntervals(episodes, bootstrap);
  for (const auto& [name, statistic] : NamedStatistics(metrics.goals)) {
    const auto value = statistic(metrics);
    if (!value) continue;
    ReportFigure figure{run.name, group, name, metrics.episodes, *value, {}, {}};
    const auto interval = intervals.find(name);
    if (interval != intervals.end()) figure.interval = interval->second;
    figure.paper = PaperValue(run.variant, group, metrics.goals, name);
    figures.push_back(std::move(figure));
  }
}

/// Success and SPL by kind of goal; the count is of executed stages.
void AddKinds(const ReportRun& run, std::vector<ReportFigure>& figures) {
  for (const KindMetrics& kind : PerKind(run.episodes)) {
    if (kind.executed == 0) continue;
    const std::string group = "kind:" + std::string(NameOf(kind.kind));
    const double sr = static_cast<double>(kind.successes) / kind.executed;
    figures.push_back({run.name, group, "SR_stage", kind.executed, sr,
                       WilsonInterval(kind.successes, kind.executed), std::nullopt});
    figures.push_back(
        {run.name, group, "SPL_stage", kind.executed, kind.spl, std::nullopt, std::nullopt});
  }
}

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

nlohmann::ordered_json CausesJson(const ReportRun& run) {
  auto causes = nlohmann::ordered_json::object();
  for (const auto& [cause, count] : CountCauses(run.episodes)) {
    auto& row = causes[cause] = {{"stages", count.stages}, {"seen_share", count.seen_share}};
    for (std::size_t i = 0; i < count.outcomes.size(); ++i) {
      if (count.outcomes[i] > 0) row["outcomes"][std::string(kOutcomeNames[i])] = count.outcomes[i];
    }
  }
  return causes;
}

}  // namespace

std::vector<ReportFigure> CollectFigures(const std::vector<ReportRun>& runs,
                                         const BootstrapConfig& bootstrap) {
  std::vector<ReportFigure> figures;
  for (const ReportRun& run : runs) {
    AddGroup(run, "all", run.episodes, bootstrap, figures);
    for (const auto& [name, episodes] : GroupByCrossFloor(run.episodes)) {
      AddGroup(run, name, episodes, bootstrap, figures);
    }
    for (const auto& [name, episodes] : GroupByTrack(run.episodes)) {
      AddGroup(run, "track:" + name, episodes, bootstrap, figures);
      for (const auto& [part, some] : GroupByCrossFloor(episodes)) {
        if (part == "cfr" || part == "same_floor")
          AddGroup(run, "track:" + name + ":" + part, some, bootstrap, figures);
      }
    }
    for (const auto& [name, episodes] : GroupByScene(run.episodes)) {
      AddGroup(run, "scene:" + name, episodes, bootstrap, figures);
    }
    AddKinds(run, figures);
  }
  return figures;
}

std::string ReportCsv(const std::vector<ReportFigure>& figures) {
  std::string text = "run,group,metric,episodes,value,low,high,paper\n";
  for (const ReportFigure& f : figures) {
    text +=
        fmt::format("{},{},{},{},{:.6f},{},{},{}\n", CsvField(f.run), CsvField(f.group), f.metric,
                    f.episodes, f.value, f.interval ? fmt::format("{:.6f}", f.interval->low) : "",
                    f.interval ? fmt::format("{:.6f}", f.interval->high) : "",
                    f.paper ? fmt::format("{:.4f}", *f.paper) : "");
  }
  return text;
}

std::string CausesCsv(const std::vector<ReportRun>& runs) {
  std::string text = "run,cause,outcome,stages\n";
  for (const ReportRun& run : runs) {
    for (const auto& [cause, count] : CountCauses(run.episodes)) {
      for (std::size_t i = 0; i < count.outcomes.size(); ++i) {
        if (count.outcomes[i] == 0) continue;
        text += fmt::format("{},{},{},{}\n", CsvField(run.name), CsvField(cause), kOutcomeNames[i],
                            count.outcomes[i]);
      }
    }
  }
  return text;
}

std::string ReportJson(const std::vector<ReportRun>& runs,
                       const std::vector<ReportFigure>& figures) {
  Json run_list = Json::array(), figure_list = Json::array();
  for (const ReportRun& run : runs) {
    run_list.push_back({{"name", run.name},
                        {"variant", run.variant},
                        {"perception", run.perception},
                        {"config_hash", run.config_hash},
                        {"episodes_hash", run.episodes_hash},
                        {"episodes", run.episodes.size()},
                        {"failed", CountFailures(run.episodes)},
                        {"causes", CausesJson(run)}});
  }
  for (const ReportFigure& f : figures) {
    Json row = {{"run", f.run},
                {"group", f.group},
                {"metric", f.metric},
                {"episodes", f.episodes},
                {"value", f.value}};
    if (f.interval) {
      row["low"] = f.interval->low;
      row["high"] = f.interval->high;
    }
    if (f.paper) row["paper"] = *f.paper;
    figure_list.push_back(std::move(row));
  }
  return Json({{"runs", std::move(run_list)}, {"figures", std::move(figure_list)}}).dump(1);
}

}  // namespace crossnav::evaluation
