// SPDX-License-Identifier: MIT
// `crossnav merge`: the shards of a run as one result file.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/bench/output_path.h"
#include "crossnav/bench/result_records.h"

namespace crossnav::app {

Result<void> Merge(const MergeOptions& options, const CommonOptions& /*common*/, Console& console) {
  if (auto ok = bench::CheckOutputFile(options.out, "--out"); !ok) return ok;
  if (auto ok = bench::CheckNoneTwice({options.runs.begin(), options.runs.end()}); !ok) return ok;
  std::vector<std::filesystem::path> files;
  for (const std::string& run : options.runs) {
    const auto found = bench::ResultFilesOf(run);
    if (!found) return tl::unexpected(found.error());
    files.insert(files.end(), found->begin(), found->end());
  }
  if (auto ok = bench::CheckNoneTwice(files); !ok) return ok;
  const auto merged = bench::MergeResults(files, /*require_all=*/!options.partial);
  if (!merged) return tl::unexpected(merged.error());
  if (merged->episodes.empty() && !merged->header) {
    return Fail(ErrorCode::kInvalid, "holds no result record", files.front().string());
  }
  if (auto ok = bench::WriteResults(options.out, *merged); !ok) return ok;
  console.Print(fmt::format("{}: {} episodes of {} files\n", options.out, merged->episodes.size(),
                            files.size()));
  console.Document(nlohmann::ordered_json(
      {{"file", options.out}, {"episodes", merged->episodes.size()}, {"files", files.size()}}));
  return {};
}

}  // namespace crossnav::app
