// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/reporting/gaps.h"
#include "crossnav/evaluation/reporting/report.h"

namespace crossnav::app {

Result<void> ShowGaps(const GapsOptions& options, const CommonOptions& /*common*/,
                      Console& console) {
  const std::vector<std::filesystem::path> paths(options.runs.begin(), options.runs.end());
  if (auto ok = evaluation::CheckNoneTwice(paths); !ok) return ok;
  const auto runs = evaluation::ReadRuns(paths, /*require_all=*/false);
  if (!runs) return tl::unexpected(runs.error());
  const auto gaps = evaluation::AttributeGaps(*runs, {});
  if (!gaps) return tl::unexpected(gaps.error());
  console.Print(evaluation::GapsText(*gaps));
  console.Document(nlohmann::ordered_json::parse(evaluation::GapsJson(*gaps)));
  return {};
}

}  // namespace crossnav::app
