// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/bench/output_path.h"
#include "crossnav/trace/replay_page.h"
#include "shell.h"

namespace crossnav::app {

Result<void> ReplayExport(const ReplayOptions& options, const CommonOptions& /*common*/,
                          Console& console) {
  if (auto ok = bench::CheckOutputFile(options.out, "--out"); !ok) return ok;
  if (auto ok = bench::CheckNotInput(options.out, "--out", options.file); !ok) return ok;
  const bool is_rerun = options.out.ends_with(".rrd");
  if (!options.compare.empty()) {
    if (auto ok = bench::CheckNotInput(options.out, "--out", options.compare); !ok) return ok;
    if (is_rerun)
      return Fail(ErrorCode::kUnsupported, "makes a page; name an .html file with --out",
                  "--compare");
    if (auto ok = trace::ExportComparison(options.file, options.compare, options.out); !ok)
      return ok;
  } else if (is_rerun) {
    if (auto ok = RunPythonModule("crossnav.rerun", "rerun", {options.file, "--to", options.out});
        !ok)
      return ok;
  } else if (auto ok = trace::ExportReplayPage(options.file, options.out); !ok) {
    return ok;
  }
  console.Print(options.out + "\n");
  console.Document(nlohmann::ordered_json({{"file", options.out}}));
  return {};
}

}  // namespace crossnav::app
