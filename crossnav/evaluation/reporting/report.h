// SPDX-License-Identifier: MIT
// A report over one or more runs: tables per run, per stage, per floor requirement, per scene and
// category, outcomes, with the paper's numbers beside; Markdown, CSV, JSON, SVG. Comparisons of two
// runs: comparison.h.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// One run as a report shows it.
struct ReportRun {
  std::string name;              ///< of its folder
  std::filesystem::path folder;  ///< where its files lie
  std::string variant;           ///< as --variant; empty where unknown
  std::string perception, config_hash, episodes_hash;
  std::vector<EpisodeRecord> episodes;
  std::optional<RunHeader> header;  ///< absent in files of other programs
};

/// Reads runs: folders with results*.jsonl, or single files. Errors: a file that does not fit, and
/// unless `require_all` is false a run that is not finished.
Result<std::vector<ReportRun>> ReadRuns(const std::vector<std::filesystem::path>& paths,
                                        bool require_all);

/// One figure, as a row of the CSV and the JSON file.
struct ReportFigure {
  std::string run, group, metric;
  int episodes = 0;
  double value = 0;
  std::optional<Interval> interval;
  std::optional<double> paper;  ///< of the paper's method that stands beside this variant
};

/// All figures of all runs, for "all", each floor group, each scene.
std::vector<ReportFigure> CollectFigures(const std::vector<ReportRun>& runs,
                                         const BootstrapConfig& bootstrap);

std::string ReportMarkdown(const std::vector<ReportRun>& runs,
                           const std::vector<ReportFigure>& figures);
/// A text as one cell of a Markdown table.
std::string OneCell(std::string text);
std::string ReportCsv(const std::vector<ReportFigure>& figures);
/// How many stages failed of which cause and with which outcome (cause.h), as rows.
std::string CausesCsv(const std::vector<ReportRun>& runs);
std::string ReportJson(const std::vector<ReportRun>& runs,
                       const std::vector<ReportFigure>& figures);

/// Bars per stage of "SR_cond" or "SPL_cond", the paper's values as lines.
std::string StagePlotSvg(const std::vector<ReportRun>& runs,
                         const std::vector<ReportFigure>& figures, const std::string& metric);
/// Stacked bars of outcomes per category of one run, the paper's beside.
std::string OutcomePlotSvg(const ReportRun& run);

}  // namespace crossnav::evaluation
