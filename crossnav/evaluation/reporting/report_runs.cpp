// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/reporting/report.h"

namespace crossnav::evaluation {
namespace {

Result<ReportRun> ReadRun(const std::filesystem::path& path, bool require_all) {
  const auto files = ResultFilesOf(path);
  if (!files) return tl::unexpected(files.error());
  auto merged = MergeResults(*files, require_all);
  if (!merged) return tl::unexpected(merged.error());
  if (merged->episodes.empty()) return Fail(ErrorCode::kInvalid, "holds no episode", path.string());
  ReportRun run;
  run.name =
      path.filename().empty() ? path.parent_path().filename().string() : path.filename().string();
  run.folder = std::filesystem::is_directory(path) ? path : path.parent_path();
  if (merged->header) {
    run.variant = merged->header->variant;
    run.perception = merged->header->perception;
    run.config_hash = merged->header->config_hash;
    run.episodes_hash = merged->header->episodes_hash;
  }
  run.header = std::move(merged->header);
  run.episodes = JudgedEpisodes(merged->episodes);
  if (run.episodes.empty()) {
    return Fail(ErrorCode::kInvalid, "holds only episodes that do not fit their scenes",
                path.string());
  }
  if (const auto tracks = GroupByTrack(run.episodes); tracks.size() == 1)
    run.name = tracks.begin()->first + "/" + run.name;
  return run;
}

/// Runs of the same name would share their rows.
void MakeNamesUnique(std::vector<ReportRun>& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    int same = 0;
    for (std::size_t j = 0; j < i; ++j) same += runs[j].name == runs[i].name ? 1 : 0;
    if (same > 0) runs[i].name += " (" + std::to_string(i + 1) + ")";
  }
}

}  // namespace

Result<std::vector<ReportRun>> ReadRuns(const std::vector<std::filesystem::path>& paths,
                                        bool require_all) {
  std::vector<ReportRun> runs;
  for (const auto& path : paths) {
    auto run = ReadRun(path, require_all);
    if (!run) return tl::unexpected(run.error());
    runs.push_back(std::move(*run));
  }
  MakeNamesUnique(runs);
  return runs;
}

}  // namespace crossnav::evaluation
