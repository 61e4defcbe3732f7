// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/bench/comparison.h"
#include "crossnav/bench/gzip_file.h"
#include "crossnav/bench/output_path.h"
#include "crossnav/bench/report.h"
#include "crossnav/bench/result_records.h"

namespace crossnav::app {
namespace {

/// The result files of a run: the file itself, or all results*.jsonl of its folder.
Result<std::vector<std::filesystem::path>> FilesOf(const std::filesystem::path& run) {
  std::error_code error;
  if (std::filesystem::is_regular_file(run, error)) return std::vector{run};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(run, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("results") && name.ends_with(".jsonl")) files.push_back(entry.path());
  }
  if (files.empty()) {
    return Fail(ErrorCode::kNotFound, "holds no results*.jsonl; run `crossnav eval` first",
                run.string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<bench::ReportRun> ReadRun(const std::filesystem::path& path, bool require_all) {
  const auto files = FilesOf(path);
  if (!files) return tl::unexpected(files.error());
  auto merged = bench::MergeResults(*files, require_all);
  if (!merged) return tl::unexpected(merged.error());
  if (merged->episodes.empty()) return Fail(ErrorCode::kInvalid, "holds no episode", path.string());
  bench::ReportRun run;
  run.name =
      path.filename().empty() ? path.parent_path().filename().string() : path.filename().string();
  if (merged->header) {
    run.variant = merged->header->variant;
    run.perception = merged->header->perception;
    run.config_hash = merged->header->config_hash;
    run.episodes_hash = merged->header->episodes_hash;
  }
  run.header = std::move(merged->header);
  run.episodes = std::move(merged->episodes);
  return run;
}

/// Runs of one name would share their rows.
void MakeNamesUnique(std::vector<bench::ReportRun>& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    int same = 0;
    for (std::size_t j = 0; j < i; ++j) same += runs[j].name == runs[i].name ? 1 : 0;
    if (same > 0) runs[i].name += " (" + std::to_string(i + 1) + ")";
  }
}

using Pages = std::vector<std::pair<std::string, std::string>>;  // file name, content

Pages MakePages(const std::vector<bench::ReportRun>& runs,
                const std::vector<bench::Comparison>& comparisons) {
  const auto figures = bench::CollectFigures(runs, {});
  Pages pages = {{"report.md", bench::ReportMarkdown(runs, figures)},
                 {"report.csv", bench::ReportCsv(figures)},
                 {"causes.csv", bench::CausesCsv(runs)},
                 {"report.json", bench::ReportJson(runs, figures)},
                 {"conditional_sr.svg", bench::StagePlotSvg(runs, figures, "SR_cond")},
                 {"conditional_spl.svg", bench::StagePlotSvg(runs, figures, "SPL_cond")}};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    pages.emplace_back("outcomes_" + std::to_string(r + 1) + ".svg",
                       bench::OutcomePlotSvg(runs[r]));
  }
  for (const bench::Comparison& comparison : comparisons) {
    pages[0].second += bench::ComparisonMarkdown(comparison);
  }
  if (!comparisons.empty()) {
    pages.emplace_back("comparison.json", bench::ComparisonsJson(comparisons));
  }
  pages[0].second += "\n## Plots\n\n";
  for (const auto& [name, content] : pages) {
    if (name.ends_with(".svg"))
      pages[0].second.append("![").append(name).append("](").append(name).append(")\n");
  }
  return pages;
}

/// Every run against the first.
Result<std::vector<bench::Comparison>> CompareAll(const std::vector<bench::ReportRun>& runs,
                                                  bool is_forced) {
  std::vector<bench::Comparison> comparisons;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    auto comparison = bench::CompareRuns(runs[0], runs[i], {}, is_forced);
    if (!comparison) return tl::unexpected(comparison.error());
    comparisons.push_back(std::move(*comparison));
  }
  return comparisons;
}

}  // namespace

Result<void> Report(const ReportOptions& options, const CommonOptions& /*common*/,
                    Console& console) {
  if (auto ok = bench::CheckOutputFolder(options.out, "--out"); !ok) return ok;
  std::vector<bench::ReportRun> runs;
  for (const std::string& path : options.runs) {
    auto run = ReadRun(path, !options.partial);
    if (!run) return tl::unexpected(run.error());
    runs.push_back(std::move(*run));
  }
  MakeNamesUnique(runs);
  const auto comparisons = CompareAll(runs, options.force);
  if (!comparisons) return tl::unexpected(comparisons.error());
  for (const auto& comparison : *comparisons) console.Print(bench::ComparisonText(comparison));
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const auto& [name, content] : MakePages(runs, *comparisons)) {
    const auto path = std::filesystem::path(options.out) / name;
    if (auto ok = bench::WriteTextFile(path, content); !ok) return ok;
    console.Print(path.string() + "\n");
    files.push_back(path.string());
  }
  console.Document(
      nlohmann::ordered_json(
          {{"files", files},
           {"comparisons", nlohmann::ordered_json::parse(bench::ComparisonsJson(*comparisons))}})
          .dump());
  return {};
}

}  // namespace crossnav::app
