// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/trace/replay_page.h"
#include "shell.h"
#include "verbs.h"

namespace crossnav::app {

Result<void> ReplayExport(const ReplayOptions& options, const CommonOptions& /*common*/,
                          Console& console) {
  if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  if (auto ok = evaluation::CheckNotInput(options.out, "--out", options.file); !ok) return ok;
  const bool is_rerun = options.out.ends_with(".rrd");
  if (!options.compare.empty()) {
    if (auto ok = evaluation::CheckNotInput(options.out, "--out", options.compare); !ok) return ok;
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

void AddReplay(CLI::App& app, Options& o) {
  CLI::App* replay = app.add_subcommand("replay", "Work with replays");
  replay->require_subcommand(1);
  CLI::App* page = AddVerb(*replay, o, "export", "A self-contained page, or a recording for Rerun",
                           "crossnav replay export episode.mcap --out episode.html",
                           [&o](Console& c) { return ReplayExport(o.replay, o.common, c); });
  page->add_option("REPLAY", o.replay.file, "Replay (.mcap)")->required();
  page->add_option("--compare", o.replay.compare,
                   "Another replay of the same episode: the page opens at their first difference");
  page->add_option("--out,--to", o.replay.out,
                   "Page to write (.html), or Rerun recording (.rrd, by the Python package)")
      ->required();
}

}  // namespace crossnav::app
