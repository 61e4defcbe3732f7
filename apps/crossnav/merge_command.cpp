// SPDX-License-Identifier: MIT
// `crossnav merge`: the shards of a run as one result file.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::app {

Result<void> Merge(const MergeOptions& options, const CommonOptions& /*common*/, Console& console) {
  if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  if (auto ok = evaluation::CheckNoneTwice({options.runs.begin(), options.runs.end()}); !ok)
    return ok;
  std::vector<std::filesystem::path> files;
  for (const std::string& run : options.runs) {
    const auto found = evaluation::ResultFilesOf(run);
    if (!found) return tl::unexpected(found.error());
    files.insert(files.end(), found->begin(), found->end());
  }
  if (auto ok = evaluation::CheckNoneTwice(files); !ok) return ok;
  const auto merged = evaluation::MergeResults(files, /*require_all=*/!options.partial);
  if (!merged) return tl::unexpected(merged.error());
  if (merged->episodes.empty() && !merged->header) {
    return Fail(ErrorCode::kInvalid, "holds no result record", files.front().string());
  }
  if (auto ok = evaluation::WriteResults(options.out, *merged); !ok) return ok;
  console.Print(fmt::format("{}: {} episodes of {} files\n", options.out, merged->episodes.size(),
                            files.size()));
  console.Document(nlohmann::ordered_json(
      {{"file", options.out}, {"episodes", merged->episodes.size()}, {"files", files.size()}}));
  return {};
}

}  // namespace crossnav::app
