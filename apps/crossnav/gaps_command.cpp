// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/bench/gaps.h"
#include "crossnav/bench/output_path.h"
#include "crossnav/bench/report.h"

namespace crossnav::app {

Result<void> ShowGaps(const GapsOptions& options, const CommonOptions& /*common*/,
                      Console& console) {
  const std::vector<std::filesystem::path> paths(options.runs.begin(), options.runs.end());
  if (auto ok = bench::CheckNoneTwice(paths); !ok) return ok;
  const auto runs = bench::ReadRuns(paths, /*require_all=*/false);
  if (!runs) return tl::unexpected(runs.error());
  const auto gaps = bench::AttributeGaps(*runs, {});
  if (!gaps) return tl::unexpected(gaps.error());
  console.Print(bench::GapsText(*gaps));
  console.Document(nlohmann::ordered_json::parse(bench::GapsJson(*gaps)));
  return {};
}

}  // namespace crossnav::app
