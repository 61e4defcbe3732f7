// SPDX-License-Identifier: MIT
#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/reporting/metrics_report.h"

namespace crossnav::app {

Result<void> ShowMetrics(const MetricsOptions& options, const CommonOptions& /*common*/,
                         Console& console) {
  const std::vector<std::filesystem::path> paths(options.files.begin(), options.files.end());
  if (auto ok = evaluation::CheckNoneTwice(paths); !ok) return ok;
  const auto results = evaluation::MergeTracks(paths);
  if (!results) return tl::unexpected(results.error());
  if (results->has_torn_line)
    console.Log(options.files[0] + ": the last line is cut off, left out");
  if (results->episodes.empty()) {
    return Fail(ErrorCode::kInvalid, "holds no episode", options.files[0]);
  }
  console.Print(evaluation::MetricsText(results->episodes, {}));
  if (console.json()) console.Document(evaluation::MetricsJson(results->episodes, {}));
  return {};
}

}  // namespace crossnav::app
