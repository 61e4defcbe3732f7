// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/reporting/comparison.h"
#include "crossnav/evaluation/reporting/report.h"
#include "shell.h"

namespace crossnav::app {
namespace {

using Pages = std::vector<std::pair<std::string, std::string>>;  // file name, content

Pages MakePages(const std::vector<evaluation::ReportRun>& runs,
                const std::vector<evaluation::Comparison>& comparisons,
                const std::filesystem::path& folder) {
  const auto figures = evaluation::CollectFigures(runs, {});
  Pages pages = {{"report.md", evaluation::ReportMarkdown(runs, figures)},
                 {"report.csv", evaluation::ReportCsv(figures)},
                 {"causes.csv", evaluation::CausesCsv(runs)},
                 {"report.json", evaluation::ReportJson(runs, figures)},
                 {"conditional_sr.svg", evaluation::StagePlotSvg(runs, figures, "SR_cond")},
                 {"conditional_spl.svg", evaluation::StagePlotSvg(runs, figures, "SPL_cond")}};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    pages.emplace_back("outcomes_" + std::to_string(r + 1) + ".svg",
                       evaluation::OutcomePlotSvg(runs[r]));
  }
  for (const evaluation::Comparison& comparison : comparisons) {
    pages[0].second += evaluation::ComparisonMarkdown(comparison, folder);
  }
  if (!comparisons.empty()) {
    pages.emplace_back("comparison.json", evaluation::ComparisonsJson(comparisons));
  }
  pages[0].second += "\n## Plots\n\n";
  for (const auto& [name, content] : pages) {
    if (name.ends_with(".svg"))
      pages[0].second.append("![").append(name).append("](").append(name).append(")\n");
  }
  return pages;
}

std::string TracksOf(const evaluation::ReportRun& run) {
  std::string tracks;
  for (const auto& [name, episodes] : evaluation::GroupByTrack(run.episodes)) tracks += name + " ";
  return tracks;
}

/// Every run against the first run of its track.
Result<std::vector<evaluation::Comparison>> CompareAll(
    const std::vector<evaluation::ReportRun>& runs, bool is_forced) {
  std::vector<evaluation::Comparison> comparisons;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const auto first = std::find_if(
        runs.begin(), runs.end(),
        [&](const evaluation::ReportRun& run) { return TracksOf(run) == TracksOf(runs[i]); });
    if (&*first == &runs[i]) continue;
    auto comparison = evaluation::CompareRuns(*first, runs[i], {}, is_forced);
    if (!comparison) return tl::unexpected(comparison.error());
    comparisons.push_back(std::move(*comparison));
  }
  return comparisons;
}

/// Writes report.html in `folder`.
Result<std::string> WriteHtmlPage(const ReportOptions& options) {
  std::string page = (std::filesystem::path(options.out) / "report.html").string();
  std::vector<std::string> words = options.runs;
  words.insert(words.end(), {"--out", page});
  if (options.partial) words.emplace_back("--partial");
  if (auto ok = RunPythonModule("crossnav.report", "report", words); !ok) {
    return tl::unexpected(ok.error());
  }
  return page;
}

}  // namespace

Result<void> Report(const ReportOptions& options, const CommonOptions& /*common*/,
                    Console& console) {
  if (auto ok = evaluation::CheckOutputFolder(options.out, "--out"); !ok) return ok;
  if (auto ok = evaluation::CheckNoneTwice({options.runs.begin(), options.runs.end()}); !ok)
    return ok;
  const auto runs =
      evaluation::ReadRuns({options.runs.begin(), options.runs.end()}, !options.partial);
  if (!runs) return tl::unexpected(runs.error());
  const auto comparisons = CompareAll(*runs, options.force);
  if (!comparisons) return tl::unexpected(comparisons.error());
  for (const auto& comparison : *comparisons) console.Print(evaluation::ComparisonText(comparison));
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const auto& [name, content] : MakePages(*runs, *comparisons, options.out)) {
    const auto path = std::filesystem::path(options.out) / name;
    if (auto ok = evaluation::WriteTextFile(path, content); !ok) return ok;
    console.Print(path.string() + "\n");
    files.push_back(path.string());
  }
  if (options.page) {
    const auto page = WriteHtmlPage(options);
    if (!page) return tl::unexpected(page.error());
    console.Print(*page + "\n");
    files.push_back(*page);
  }
  console.Document(nlohmann::ordered_json(
      {{"files", files},
       {"comparisons", nlohmann::ordered_json::parse(evaluation::ComparisonsJson(*comparisons))}}));
  return {};
}

}  // namespace crossnav::app
