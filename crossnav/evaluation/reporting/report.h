// SPDX-License-Identifier: MIT
// Report over runs: tables per run, per stage, per floor requirement, per scene and category,
// outcomes, with the paper's numbers beside; Markdown, CSV, JSON, SVG. Comparisons of two runs:
// comparison.h.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// A run in a report.
struct ReportRun {
  std::string name;              ///< of its folder
  std::filesystem::path folder;  ///< where its files lie
  std::string variant;           ///< as --variant; empty where unknown
  std::string perception, config_hash, episodes_hash;
  std::vector<EpisodeRecord> episodes;
  std::optional<RunHeader> header;  ///< absent in files of other programs
};

/// Reads runs: folders with results*.jsonl, or single files. Errors: a file that does not fit, and,
/// unless `require_all` is false, an unfinished run.
Result<std::vector<ReportRun>> ReadRuns(const std::vector<std::filesystem::path>& paths,
                                        bool require_all);

/// A figure, as a row of the CSV and the JSON file.
struct ReportFigure {
  std::string run, group, metric;
  int episodes = 0;
  double value = 0;
  std::optional<Interval> interval;
  std::optional<double> paper;  ///< of the paper's counterpart of this variant
};

/// All figures of all runs, for "all", each floor group, each scene.
std::vector<ReportFigure> CollectFigures(const std::vector<ReportRun>& runs,
                                         const BootstrapConfig& bootstrap);

std::string ReportMarkdown(const std::vector<ReportRun>& runs,
                           const std::vector<ReportFigure>& figures);
/// A text as one cell of a Markdown table.
std::string OneCell(std::string text);
std::string ReportCsv(const std::vector<ReportFigure>& figures);
/// Number of failed stages by cause (cause.h) and outcome, as rows.
std::string CausesCsv(const std::vector<ReportRun>& runs);
std::string ReportJson(const std::vector<ReportRun>& runs,
                       const std::vector<ReportFigure>& figures);

/// Bars per stage of "SR_cond" or "SPL_cond", with the paper's values as lines.
std::string StagePlotSvg(const std::vector<ReportRun>& runs,
                         const std::vector<ReportFigure>& figures, const std::string& metric);
/// Stacked bars of outcomes per category of one run, with the paper's beside.
std::string OutcomePlotSvg(const ReportRun& run);

}  // namespace crossnav::evaluation
